#pragma once

#include <array>
#include <optional>
#include <span>

#include "engine/splat/tracking_loss.h"
#include "shaders/shared/align_begin.h"
#include "shaders/shared/align_evidence.h"
#include "shaders/shared/align_halve.h"
#include "shaders/shared/align_points.h"
#include "shaders/shared/align_rendered.h"
#include "shaders/shared/align_sensor.h"
#include "shaders/shared/align_step.h"
#include "shaders/shared/align_sums.h"

namespace surefield {

/// Finds the pose of a frame in a fixed map by Gauss-Newton (docs/method.md, "Second-order tracking"). The
/// map is rendered at the pose so far; the points of the render, and of the images of some keyframes, are
/// aligned to the frame, coarse to fine, by intensity and by their distance along the normal, with the
/// weights of t-distributions; then the map is rendered again. One or a few renders take the place of dozens.
/// The render that a frame ended with serves the next one to be aligned to, where it was kept, while the map
/// stays as it is and the camera near. Everything but the decision to stop is on the device.
class GaussNewtonTracker {
 public:
  explicit GaussNewtonTracker(gpu::Device& device);

  /// Keyframes whose images frames can be aligned to beside the map have places.
  static constexpr std::size_t kReferences = glsl::ALIGN_REFERENCES;
  /// Whether a place holds the images of this frame.
  bool holds(std::size_t place, FrameHandle frame) const { return held_[place] == frame; }
  /// Puts the images of a frame, taken with these intrinsics, in a place; a change of size empties all
  /// places.
  void hold(std::size_t place, FrameHandle handle, const SensorFrame& frame, const Intrinsics& intrinsics);

  /// The images of a frame have changed: no place holds it any more.
  void drop(FrameHandle frame);

  /// Keeps the render that the last track() ended with: the next frames are aligned to it.
  void keep_render();
  /// The map has changed: no frame is aligned to a render of before.
  void forget_render();

  /// Tracks `frame` from the pose of `start`; `references` are the cameras of the frames in the first places.
  TrackingResult track(Rasteriser& rasteriser, TrackingLoss& loss, const GaussianMap& map,
                       const SensorFrame& frame, const Camera& start, const TrackingSettings& settings,
                       std::span<const Camera> references = {});

  /// Aligns `frame` to the image of the frame in the first place alone, whose camera is `reference`, from the
  /// pose of `start`. The map has no part in it.
  PairAlignment align(Rasteriser& rasteriser, const SensorFrame& frame, const Camera& start,
                      const Camera& reference, const TrackingSettings& settings);

 private:
  static constexpr int kLevels = 3;

  /// Images of one level of the pyramids.
  struct Level {
    ImageSize size;
    gpu::Array<glsl::vec2> sensor;                                           ///< intensity, depth
    gpu::Array<glsl::vec2> rendered;                                         ///< intensity, depth
    gpu::Array<glsl::AlignPoint> points;                                     ///< of the render at hand
    gpu::Array<glsl::AlignPoint> kept_points;                                ///< of the one that was kept
    std::array<gpu::Array<glsl::AlignPoint>, kReferences> reference_points;  ///< of keyframes' images
    explicit Level(gpu::Device& device);
  };

  /// What a frame is aligned to beside keyframes: the render that was kept, its own first one, or a later
  /// one.
  enum class Target { Kept, First, Later };

  /// What a frame is aligned to: so many sources, from this one on; 0 is the render, the others are keyframes.
  struct Sources {
    uint32_t first = 0;
    uint32_t count = 1;
  };

  /// Which sums of an alignment.
  struct SumsOf {
    int level = 0;
    uint32_t stride = 1;       ///< of the pixels that take part
    uint32_t source = 0;       ///< 0: the render; else a keyframe
    uint32_t part = 0;         ///< where they go
    bool kept = false;         ///< the render is the one that was kept
    bool photometric = false;  ///< of that term alone
    bool crossed = false;      ///< as evidence, of which noise is no part
  };

  /// What points of the levels are of.
  struct PointsOf {
    Camera camera;
    double minimum_opacity = 0;
    double uncertainty_above = 0;
    DepthKind depth = DepthKind::Normalised;
  };

  bool kept_render_serves(const Camera& start, const TrackingSettings& settings) const;
  void resize(gpu::Recorder& recorder, const ImageSize& size);
  void record_sensor(gpu::Recorder& recorder, const SensorFrame& frame);
  void record_halves(gpu::Recorder& recorder, gpu::Array<glsl::vec2> Level::*image);
  void record_level(gpu::Recorder& recorder, uint32_t index, const gpu::Array<glsl::vec2>& image,
                    const gpu::Array<glsl::AlignPoint>& points, float unknown);
  void record_points(gpu::Recorder& recorder, const Rasteriser& rasteriser, const TrackingSettings& settings);
  void record_begin(gpu::Recorder& recorder, const Rasteriser& rasteriser, const TrackingLoss& loss,
                    const SensorFrame& frame, const TrackingSettings& settings);
  uint32_t record_sums(gpu::Recorder& recorder, const SensorFrame& frame, const SumsOf& of,
                       const TrackingSettings& settings);
  void record_step(gpu::Recorder& recorder, const Rasteriser& rasteriser, const SensorFrame& frame, int level,
                   bool kept, const Sources& sources, const TrackingSettings& settings);
  void record_evidence(gpu::Recorder& recorder, const SensorFrame& frame, const Sources& sources,
                       const TrackingSettings& settings);
  PoseEvidence read_evidence(const SensorFrame& frame, const Sources& sources) const;
  void record_alignment(gpu::Recorder& recorder, const Rasteriser& rasteriser, const SensorFrame& frame,
                        Target target, const Sources& sources, const TrackingSettings& settings);

  gpu::Device& device_;
  uint32_t subgroups_;  ///< of a workgroup of align_sums: each writes a partial sum
  gpu::Pass<passes::align_sensor> sensor_pass_;
  gpu::Pass<passes::align_rendered> rendered_alpha_;
  gpu::Pass<passes::align_rendered> rendered_normalised_;
  gpu::Pass<passes::align_halve> halve_pass_;
  gpu::Pass<passes::align_points> points_pass_;
  gpu::Pass<passes::align_sums> sums_pass_;
  gpu::Pass<passes::align_sums> keyframe_sums_pass_;
  gpu::Pass<passes::align_sums> crossed_sums_pass_;           ///< of the evidence
  gpu::Pass<passes::align_sums> crossed_keyframe_sums_pass_;  ///< of the evidence
  gpu::Pass<passes::align_begin> begin_pass_;
  gpu::Pass<passes::align_step> step_pass_;
  gpu::Pass<passes::align_evidence> evidence_pass_;
  gpu::Array<glsl::CameraState> camera_;
  gpu::Array<glsl::AlignState> state_;
  gpu::Array<glsl::AlignSums> partial_sums_;
  gpu::Array<glsl::AlignSums> evidence_;
  std::array<Level, kLevels> levels_;
  std::array<std::optional<FrameHandle>, kReferences> held_;
  std::optional<PointsOf> last_render_;
  std::optional<PointsOf> kept_render_;
};

}  // namespace surefield
