#include "engine/io/file_dataset.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "engine/io/error.h"
#include "engine/io/files.h"

namespace surefield {

namespace {

std::string size_problem(const std::filesystem::path& file, const cv::Mat& image,
                         const Intrinsics& expected) {
  if (image.cols == expected.width && image.rows == expected.height) return {};
  return fmt::format("{}: is {} x {} pixels, the calibration is for {} x {}", file.string(), image.cols,
                     image.rows, expected.width, expected.height);
}

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

FileDataset::FileDataset(StoredSequence sequence) : sequence_(std::move(sequence)) {
  if (sequence_.distortion.empty()) return;
  const Intrinsics& k = sequence_.intrinsics;
  const cv::Matx33d camera(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
  cv::initUndistortRectifyMap(camera, sequence_.distortion, cv::noArray(), camera,
                              cv::Size(k.width, k.height), CV_32FC1, undistortion_x_, undistortion_y_);
}

LoadedFrame FileDataset::load(int i) const {
  const StoredFrame& stored = sequence_.frames.at(static_cast<std::size_t>(i));
  LoadedFrame loaded;
  try {
    Frame frame;
    frame.index = i;
    frame.timestamp = stored.timestamp;
    frame.colour = read_colour(stored.colour);
    frame.depth = read_depth(stored.depth, sequence_.depth_encoding);
    loaded.problem = size_problem(stored.colour, frame.colour, sequence_.intrinsics);
    if (loaded.problem.empty())
      loaded.problem = size_problem(stored.depth, frame.depth, sequence_.intrinsics);
    if (!loaded.problem.empty()) return loaded;
    if (!undistortion_x_.empty()) undistort(frame);
    loaded.frame = std::move(frame);
  } catch (const InputError& error) {
    loaded.problem = error.what();
  }
  return loaded;
}

const Trajectory* FileDataset::ground_truth() const {
  return sequence_.ground_truth ? &*sequence_.ground_truth : nullptr;
}

void FileDataset::undistort(Frame& frame) const {
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
