#include "engine/sources/file_recording.h"

#include <fmt/format.h>

#include <iterator>
#include <new>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "engine/io/files.h"
#include "engine/types/error.h"
#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr std::size_t kLargestGap =
    20;  // times as many numbers as there are images; the numbers are stamps then

cv::Size size_of(const Intrinsics& camera) {
  return {camera.width, camera.height};
}

/// Adds the numbers that lack. Where there would be very many the numbers are no count but stamps, and none
/// lacks.
void fill_gaps(std::map<int, StoredFrame>& frames) {
  std::vector<double> steps;
  for (auto frame = std::next(frames.begin()); frame != frames.end(); ++frame)
    steps.push_back(frame->first - std::prev(frame)->first);
  if (steps.empty()) return;
  const int step = static_cast<int>(median(steps));
  const int first = frames.begin()->first, last = frames.rbegin()->first;
  if (static_cast<std::size_t>(last / step - first / step) >= kLargestGap * frames.size()) return;
  for (int number = first; number < last - step; number += step) frames.try_emplace(number);
}

}  // namespace

std::vector<StoredFrame> numbered_frames(const NumberedFolder& folder) {
  std::map<int, StoredFrame> frames;
  for (const auto* images : {&folder.colours, &folder.depths})
    for (const auto& [number, file] : *images) frames.try_emplace(number);
  if (frames.empty()) return {};
  if (folder.fill_gaps) fill_gaps(frames);
  const auto find = [](const auto& images, int number, const auto& name) {
    const auto found = images.find(number);
    return found != images.end() ? found->second : name(number);
  };
  std::vector<StoredFrame> list;
  for (const auto& [number, frame] : frames)
    list.push_back({static_cast<double>(number), find(folder.colours, number, folder.colour_name),
                    find(folder.depths, number, folder.depth_name)});
  return list;
}

cv::Size stored_size(const std::vector<StoredFrame>& frames) {
  std::string problem = "no frame";
  for (const StoredFrame& frame : frames) {
    try {
      return read_depth(find_spelling(frame.depth), {}).size();
    } catch (const InputError& error) {
      problem = error.what();
    }
  }
  throw InputError("no depth image can be read; " + problem);
}

FileRecording::FileRecording(StoredSequence sequence)
    : sequence_(std::move(sequence)), undistortion_({sequence_.intrinsics, sequence_.distortion, 0}) {}

LoadedFrame FileRecording::load(int i) const {
  try {
    return {read_frame(i), ""};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return {std::nullopt, describe_current_exception()};
  }
}

Frame FileRecording::read_frame(int i) const {
  const StoredFrame& stored = sequence_.frames.at(static_cast<std::size_t>(i));
  Frame frame;
  frame.index = i;
  frame.timestamp = stored.timestamp;
  frame.depth_after = depth_after(i);
  frame.colour = load_colour(find_spelling(stored.colour));
  frame.depth = load_depth(find_spelling(stored.depth));
  undistortion_.apply(frame);
  return frame;
}

cv::Mat FileRecording::load_colour(const std::filesystem::path& file) const {
  const cv::Size size = size_of(sequence_.intrinsics);
  if (!sequence_.resize_colour) return read_colour(file, size);
  cv::Mat colour = read_colour(file);
  cv::resize(colour, colour, size, 0, 0, cv::INTER_AREA);
  return colour;
}

cv::Mat FileRecording::load_depth(const std::filesystem::path& file) const {
  const auto& registration = sequence_.registration;
  const cv::Size size = size_of(registration ? registration->depth : sequence_.intrinsics);
  const cv::Mat depth = read_depth(file, sequence_.depth_encoding, size);
  return registration ? register_depth(depth, *registration) : depth;
}

}  // namespace surefield
