#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/dataset.h"
#include "engine/io/images.h"

namespace surefield {

/// Where one frame is stored.
struct StoredFrame {
  double timestamp = 0;  ///< seconds
  std::filesystem::path colour;
  std::filesystem::path depth;
};

/// What a reader finds out about a sequence of image files.
struct StoredSequence {
  std::string name;
  std::string format;
  Intrinsics intrinsics;
  std::vector<double> distortion;  ///< OpenCV's k1 k2 p1 p2 k3; empty where the images have none
  DepthEncoding depth_encoding;
  std::vector<StoredFrame> frames;
  std::optional<Trajectory> ground_truth;
  std::vector<std::string> warnings;
};

/// A dataset of one colour and one depth file per frame; all readers of such layouts end here.
class FileDataset : public Dataset {
 public:
  /// `sequence` has at least one frame.
  explicit FileDataset(StoredSequence sequence);

  std::string name() const override { return sequence_.name; }
  std::string format() const override { return sequence_.format; }
  int size() const override { return static_cast<int>(sequence_.frames.size()); }
  Intrinsics intrinsics() const override { return sequence_.intrinsics; }
  double depth_unit() const override { return sequence_.depth_encoding.unit; }
  double timestamp(int i) const override {
    return sequence_.frames.at(static_cast<std::size_t>(i)).timestamp;
  }
  LoadedFrame load(int i) const override;
  const Trajectory* ground_truth() const override;
  std::vector<std::string> warnings() const override { return sequence_.warnings; }

 private:
  void undistort(Frame& frame) const;

  StoredSequence sequence_;
  cv::Mat undistortion_x_;  ///< for each undistorted pixel the place in the stored image; empty without
                            ///< distortion
  cv::Mat undistortion_y_;
};

/// How a numbered file is named: `prefix`, six digits, `suffix`.
struct NumberedName {
  std::string prefix;
  std::string suffix;
};

/// The frames of a folder of numbered images, from the lowest to the highest number among the colour images;
/// a gap becomes a frame that fails to load. The time stamp is the number, in seconds.
std::vector<StoredFrame> numbered_frames(const std::filesystem::path& folder, const NumberedName& colour,
                                         const NumberedName& depth);

/// The layouts: `is_...` tells from the names of files whether a folder has the layout, `k...Layout` says
/// what is looked for, `read_..._sequence` throws InputError.
bool is_tum(const std::filesystem::path& folder);
bool is_replica(const std::filesystem::path& folder);
bool is_sevenscenes(const std::filesystem::path& folder);
inline constexpr const char* kTumLayout = "rgb.txt and depth.txt";
inline constexpr const char* kReplicaLayout = "results/frame000000.jpg or .png";
inline constexpr const char* kSevenScenesLayout = "frame-000000.color.jpg or .png";
StoredSequence read_tum_sequence(const std::filesystem::path& folder);
StoredSequence read_replica_sequence(const std::filesystem::path& folder);
StoredSequence read_sevenscenes_sequence(const std::filesystem::path& folder);

}  // namespace surefield
