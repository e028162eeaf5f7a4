// Recordings written as folders of images.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/io/trajectory_file.h"
#include "engine/sources/camera_file.h"
#include "engine/sources/recording_writer.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kMostSteps = 65535;

void make_empty_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder, "cannot be created: " + error.message());
  if (!std::filesystem::is_empty(folder, error) || error)
    throw InputError(folder, "is not empty; give a new folder");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) throw InputError(folder, "cannot be created: " + error.message());
}

/// Depth in steps of the unit; what is no multiple of it, or too far, is refused or rounded, or left out.
cv::Mat depth_steps(const Frame& frame, const WrittenRecording& recording) {
  cv::Mat steps(frame.depth.size(), CV_16UC1, cv::Scalar(0));
  int lost = 0;
  for (int v = 0; v < steps.rows; ++v)
    for (int u = 0; u < steps.cols; ++u) {
      const float z = frame.depth.at<float>(v, u);
      if (!(z > 0) || !std::isfinite(z)) continue;
      const double step = std::round(z / recording.depth_unit);
      const bool fits = step > 0 && step <= kMostSteps;
      if (fits) steps.at<uint16_t>(v, u) = static_cast<uint16_t>(step);
      lost += !fits || static_cast<float>(step * recording.depth_unit) != z;
    }
  if (lost > 0 && !recording.lossy) {
    throw InputError(fmt::format(
        "frame {} has {} depths that are no steps of {:g} m up to 65535: the layout cannot hold them as they "
        "are; --lossy rounds them, --depth-unit gives finer steps, and --to mcap holds any depth",
        frame.index, lost, recording.depth_unit));
  }
  return steps;
}

/// What both layouts have in common.
class FolderWriter : public RecordingWriter {
 public:
  FolderWriter(std::filesystem::path folder, const char* colours, const WrittenRecording& recording)
      : folder_(std::move(folder)), colours_(colours), recording_(recording) {
    make_empty_folder(folder_);
    make_folder(folder_ / colours_);
    make_folder(folder_ / "depth");
    write_file(folder_ / kCameraFile, [&](std::ostream& stream) {
      const Intrinsics& k = recording.intrinsics;
      stream << fmt::format("width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\ndepth_unit: {}\n",
                            k.width, k.height, k.fx, k.fy, k.cx, k.cy, recording.depth_unit);
    });
  }

  /// What was broken off is no recording: the folder, which was empty, is gone again.
  ~FolderWriter() override {
    std::error_code ignored;
    if (!finished_) std::filesystem::remove_all(folder_, ignored);
  }
  FolderWriter(const FolderWriter&) = delete;
  FolderWriter& operator=(const FolderWriter&) = delete;

 protected:
  /// Writes both images; returns their name, the same in both folders.
  std::string write_images(const Frame& frame) {
    const cv::Mat steps = depth_steps(frame, recording_);
    const std::string name = fmt::format("{:06}.png", written_++);
    write_png(folder_ / colours_ / name, frame.colour);
    write_png(folder_ / "depth" / name, steps);
    return name;
  }
  void write_list(const char* name, const std::string& rows) const {
    write_file(folder_ / name, [&](std::ostream& stream) { stream << rows; });
  }
  /// The last that is written.
  void write_poses(const char* name, const std::optional<Trajectory>& truth) {
    if (truth) write_trajectory(folder_ / name, *truth);
    finished_ = true;
  }

  const std::filesystem::path folder_;
  const char* colours_;
  const WrittenRecording recording_;

 private:
  int written_ = 0;
  bool finished_ = false;
};

class TumWriter : public FolderWriter {
 public:
  TumWriter(const std::filesystem::path& folder, const WrittenRecording& recording)
      : FolderWriter(folder, "rgb", recording) {}

  void write(const WrittenFrame& frame) override {
    const std::string name = write_images(frame.frame);
    // "{}": so many digits that the same number is read.
    colour_rows_ += fmt::format("{} rgb/{}\n", frame.frame.timestamp, name);
    depth_rows_ += fmt::format("{} depth/{}\n", frame.depth_timestamp, name);
  }
  void finish(const std::optional<Trajectory>& truth) override {
    write_list("rgb.txt", colour_rows_);
    write_list("depth.txt", depth_rows_);
    write_poses("groundtruth.txt", truth);
  }

 private:
  std::string colour_rows_, depth_rows_;
};

class PlainWriter : public FolderWriter {
 public:
  PlainWriter(const std::filesystem::path& folder, const WrittenRecording& recording)
      : FolderWriter(folder, "colour", recording) {}

  void write(const WrittenFrame& frame) override {
    if (frame.depth_timestamp != frame.frame.timestamp && !recording_.lossy) {
      throw InputError(
          fmt::format("frame {} has a depth image of another time, for which the plain layout has no place; "
                      "--lossy leaves "
                      "that out, --to tum and --to mcap keep it",
                      frame.frame.index));
    }
    const std::string name = write_images(frame.frame);
    rows_ += fmt::format("{} {} {}\n", frame.frame.timestamp, name, name);
  }
  void finish(const std::optional<Trajectory>& truth) override {
    write_list("timestamps.txt", rows_);
    write_poses("poses.txt", truth);
  }

 private:
  std::string rows_;
};

}  // namespace

std::unique_ptr<RecordingWriter> write_tum(const std::filesystem::path& folder,
                                           const WrittenRecording& recording) {
  return std::make_unique<TumWriter>(folder, recording);
}

std::unique_ptr<RecordingWriter> write_plain(const std::filesystem::path& folder,
                                             const WrittenRecording& recording) {
  return std::make_unique<PlainWriter>(folder, recording);
}

}  // namespace surefield
