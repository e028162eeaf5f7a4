#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/eval/lpips.h"
#include "engine/eval/pose_track.h"
#include "engine/eval/space_metrics.h"
#include "engine/sources/recording.h"
#include "engine/types/render_images.h"

namespace surefield {

/// Means over frames of how the map's renders compare with the sensor's images.
struct ImageScores {
  int frames = 0;
  double psnr = 0;                ///< dB
  double psnr_same_exposure = 0;  ///< dB, of renders that were brought to each frame's exposure
  std::optional<double>
      psnr_covered;  ///< the same where the map is opaque (O > 0.5); over the frames that it covers
  double ssim = 0;   ///< up to 1
  std::optional<double> depth_l1;  ///< metres; over the frames with valid depth, if any
  std::optional<double> lpips;     ///< where a network was given
  SpaceCounts space;               ///< sums over the frames, not means
};

/// Scores of a run's map.
struct MapQuality {
  ImageScores all;
  ImageScores held_out;  ///< of the frames that were no keyframes: the map was not optimised on them
};

/// A frame to compare: its index in the dataset, and its camera.
struct QualityView {
  int index = 0;
  Camera camera;
  bool keyframe = false;
};

/// What to compare, and how.
struct QualityInput {
  /// The frame of an index again, at the size of the views; nullopt where it cannot be read.
  std::function<std::optional<Frame>(int index)> frame;
  std::vector<QualityView> views;
  /// Where the views' camera was, in the world of the views: a depth image that was taken at another time
  /// than its colour image is compared with the map as it is seen from there.
  PoseTrack track = {};
  DepthNoise noise;                                     ///< of the sensor
  std::function<RenderImages(const Camera&)> render;    ///< of the map
  Lpips* lpips = nullptr;                               ///< none: not measured
  std::function<void(std::size_t)> progress = nullptr;  ///< told how many views are done
};

/// QualityInput::frame for a source that can be read again: its frames at `scale`, as in FrameSelection.
/// `recording` must outlive it.
std::function<std::optional<Frame>(int)> frames_of(const Recording& recording, double scale);

/// Renders the map at every view and compares it with the frame. Frames that cannot be read take no part.
/// Stops without a result when the user interrupts; nullopt also where no frame could be compared.
std::optional<MapQuality> measure_map_quality(const QualityInput& input);

/// The scores as docs/evaluation.md describes them; numbers that do not exist are null.
nlohmann::ordered_json quality_json(const std::optional<MapQuality>& quality);

/// The same as lines for people.
std::string quality_table(const MapQuality& quality);

}  // namespace surefield
