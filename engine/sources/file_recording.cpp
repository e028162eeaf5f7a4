#include "engine/sources/file_recording.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

std::filesystem::path numbered_path(const std::filesystem::path& folder, const NumberedName& name,
                                    int number) {
  return folder / fmt::format("{}{:06}{}", name.prefix, number, name.suffix);
}

}  // namespace

std::vector<StoredFrame> numbered_frames(const std::filesystem::path& folder, const NumberedName& colour,
                                         const NumberedName& depth) {
  const auto colours = numbered_files(folder, colour.prefix, colour.suffix);
  std::vector<StoredFrame> frames;
  if (colours.empty()) return frames;
  for (int number = colours.begin()->first; number <= colours.rbegin()->first; ++number) {
    frames.push_back({static_cast<double>(number), numbered_path(folder, colour, number),
                      numbered_path(folder, depth, number)});
  }
  return frames;
}

void require_size(const std::filesystem::path& file, const cv::Mat& image, const Intrinsics& expected) {
  if (image.cols == expected.width && image.rows == expected.height) return;
  throw InputError(file, fmt::format("is {} x {} pixels, the calibration is for {} x {}", image.cols,
                                     image.rows, expected.width, expected.height));
}

cv::Size stored_size(const std::vector<StoredFrame>& frames) {
  std::string problem = "no frame";
  for (const StoredFrame& frame : frames) {
    try {
      return read_depth(frame.depth, {}).size();
    } catch (const InputError& error) {
      problem = error.what();
    }
  }
  throw InputError("no depth image can be read; " + problem);
}

FileRecording::FileRecording(StoredSequence sequence) : sequence_(std::move(sequence)) {
  if (sequence_.distortion.empty()) return;
  const Intrinsics& k = sequence_.intrinsics;
  const cv::Matx33d camera(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
  cv::initUndistortRectifyMap(camera, sequence_.distortion, cv::noArray(), camera,
                              cv::Size(k.width, k.height), CV_32FC1, undistortion_x_, undistortion_y_);
}

LoadedFrame FileRecording::load(int i) const {
  const StoredFrame& stored = sequence_.frames.at(static_cast<std::size_t>(i));
  LoadedFrame loaded;
  try {
    Frame frame;
    frame.index = i;
    frame.timestamp = stored.timestamp;
    frame.colour = load_colour(stored.colour);
    frame.depth = load_depth(stored.depth);
    if (!undistortion_x_.empty()) undistort(frame);
    loaded.frame = std::move(frame);
  } catch (const InputError& error) {
    loaded.problem = error.what();
  }
  return loaded;
}

cv::Mat FileRecording::load_colour(const std::filesystem::path& file) const {
  cv::Mat colour = read_colour(file);
  if (sequence_.resize_colour) {
    cv::resize(colour, colour, cv::Size(sequence_.intrinsics.width, sequence_.intrinsics.height), 0, 0,
               cv::INTER_AREA);
  }
  require_size(file, colour, sequence_.intrinsics);
  return colour;
}

cv::Mat FileRecording::load_depth(const std::filesystem::path& file) const {
  const cv::Mat depth = read_depth(file, sequence_.depth_encoding);
  require_size(file, depth, sequence_.registration ? sequence_.registration->depth : sequence_.intrinsics);
  return sequence_.registration ? register_depth(depth, *sequence_.registration) : depth;
}

void FileRecording::undistort(Frame& frame) const {
  cv::Mat colour;
  cv::Mat depth;
  // Beyond the stored image colour repeats the border: black there would be learnt as a dark frame around the
  // scene.
  cv::remap(frame.colour, colour, undistortion_x_, undistortion_y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::remap(frame.depth, depth, undistortion_x_, undistortion_y_, cv::INTER_NEAREST, cv::BORDER_CONSTANT, 0);
  frame.colour = colour;
  frame.depth = depth;
}

}  // namespace surefield
