#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/file_names.h"
#include "engine/io/images.h"
#include "engine/sources/camera_file.h"
#include "engine/sources/depth_registration.h"
#include "engine/sources/recording.h"
#include "engine/sources/undistortion.h"

namespace surefield {

/// Where one frame is stored.
struct StoredFrame {
  double timestamp = 0;  ///< seconds
  std::filesystem::path colour;
  std::filesystem::path depth;
  std::optional<double> depth_timestamp = std::nullopt;  ///< seconds, where the depth image has its own
};

/// What a reader finds out about a sequence of image files.
struct StoredSequence {
  std::string name;
  std::string format;
  Intrinsics intrinsics;
  LensDistortion distortion;
  DepthEncoding depth_encoding;
  std::optional<DepthRegistration>
      registration;                              ///< where the depth camera is another than the colour camera
  bool resize_colour = false;                    ///< whether colour is averaged down to the depth's size
  Pose tracked_to_reference = Pose::Identity();  ///< see FrameSource::tracked_to_reference
  std::vector<StoredFrame> frames;
  int left_out = 0;  ///< see Recording::left_out
  std::optional<Trajectory> ground_truth;
  std::vector<std::string> assumptions;  ///< see FrameSource::assumptions
  std::vector<std::string> warnings;
};

/// A recording of one colour and one depth file per frame; all readers of such layouts end here.
class FileRecording : public Recording {
 public:
  /// `sequence` has at least one frame; its ground truth is not looked at.
  explicit FileRecording(StoredSequence sequence);

  std::string name() const override { return sequence_.name; }
  std::string format() const override { return sequence_.format; }
  int count() const override { return static_cast<int>(sequence_.frames.size()); }
  Intrinsics intrinsics() const override { return sequence_.intrinsics; }
  int left_out() const override { return sequence_.left_out; }
  double depth_unit() const override { return sequence_.depth_encoding.unit; }
  double timestamp(int i) const override {
    return sequence_.frames.at(static_cast<std::size_t>(i)).timestamp;
  }
  double depth_timestamp(int i) const override {
    return sequence_.frames.at(static_cast<std::size_t>(i)).depth_timestamp.value_or(timestamp(i));
  }
  LoadedFrame load(int i) const override;
  Pose tracked_to_reference() const override { return sequence_.tracked_to_reference; }
  std::vector<std::string> assumptions() const override { return sequence_.assumptions; }
  std::vector<std::string> warnings() const override { return sequence_.warnings; }

 private:
  Frame read_frame(int i) const;
  cv::Mat load_colour(const std::filesystem::path& file) const;
  cv::Mat load_depth(const std::filesystem::path& file) const;

  StoredSequence sequence_;
  Undistortion undistortion_;
};

/// The frames of numbered images: each number that has a colour or a depth image, and those that lack between
/// them, where `fill_gaps` and the usual step between the numbers (1, or another where only every so many
/// were exported) say that some do. A frame without one of its images fails to load, with `colour_name` or
/// `depth_name` for the missing file. The time stamp is the number, in seconds.
struct NumberedFolder {
  std::map<int, std::filesystem::path> colours;
  std::map<int, std::filesystem::path> depths;
  std::function<std::filesystem::path(int)> colour_name;
  std::function<std::filesystem::path(int)> depth_name;
  bool fill_gaps = true;
};
std::vector<StoredFrame> numbered_frames(const NumberedFolder& folder);

/// The size of the first depth image that can be read. Throws InputError where there is none.
cv::Size stored_size(const std::vector<StoredFrame>& frames);

}  // namespace surefield
