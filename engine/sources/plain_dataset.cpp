// The layout for recordings of one's own: colour/ (or color/) and depth/ with images paired by equal names,
// or by timestamps.txt; camera.yaml; poses.txt where poses are known.
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/sources/camera_file.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

std::filesystem::path colour_folder(const std::filesystem::path& folder) {
  return folder / (std::filesystem::is_directory(folder / "colour") ? "colour" : "color");
}

/// Lines "seconds colour-file depth-file", in the order in which the frames were taken.
std::vector<StoredFrame> read_stamped(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  std::vector<StoredFrame> frames;
  for (const TextLine& line : read_lines(file)) {
    std::istringstream text(line.text);
    double stamp = 0;
    std::string colour, depth, rest;
    if (!(text >> stamp >> colour >> depth) || text >> rest || !std::isfinite(stamp)) {
      throw InputError(file, line.number, "expected \"seconds colour-file depth-file\"");
    }
    if (!frames.empty() && stamp <= frames.back().timestamp) {
      throw InputError(file, line.number, "is not later than the line before; sort the lines by time");
    }
    frames.push_back({stamp, colour_folder(folder) / colour, folder / "depth" / depth});
  }
  if (frames.empty()) throw InputError(file, "lists no image");
  return frames;
}

/// Pairs images of equal names, in the order of the names; the stamp is the index, in seconds.
void pair_by_name(const std::filesystem::path& folder, StoredSequence& sequence) {
  const auto colours = images_by_stem(colour_folder(folder));
  const auto depths = images_by_stem(folder / "depth");
  for (const auto& [stem, colour] : colours) {
    const auto depth = depths.find(stem);
    if (depth == depths.end()) continue;
    sequence.frames.push_back({static_cast<double>(sequence.frames.size()), colour, depth->second});
  }
  if (sequence.frames.empty()) {
    throw InputError(folder, fmt::format("none of the {} colour images has a depth image of the same name "
                                         "(extensions aside); rename them, or pair them in timestamps.txt",
                                         colours.size()));
  }
  const std::size_t lonely = colours.size() + depths.size() - 2 * sequence.frames.size();
  if (lonely > 0) {
    sequence.warnings.push_back(
        fmt::format("{} colour or depth images have no partner of the same name and are left out", lonely));
  }
}

void read_calibration(const std::filesystem::path& file, StoredSequence& sequence) {
  const RecordedCamera camera = read_camera_file(file);
  sequence.intrinsics = camera.intrinsics;
  sequence.distortion = camera.distortion;
  sequence.depth_encoding.unit = camera.depth_unit;
  if (sequence.intrinsics.width > 0) return;
  const cv::Size size = stored_size(sequence.frames);
  sequence.intrinsics.width = size.width;
  sequence.intrinsics.height = size.height;
}

}  // namespace

bool is_plain(const std::filesystem::path& folder) {
  return std::filesystem::is_directory(colour_folder(folder)) &&
         std::filesystem::is_directory(folder / "depth") && !std::filesystem::exists(folder / "intrinsic");
}

StoredSequence read_plain_sequence(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / kCameraFile)) {
    throw InputError(folder,
                     "camera.yaml is missing: fx, fy, cx, cy and depth_unit, see docs/datasets.md (and "
                     "a folder exported from ScanNet has intrinsic/)");
  }
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "plain";
  if (std::filesystem::exists(folder / "timestamps.txt")) {
    sequence.frames = read_stamped(folder / "timestamps.txt");
  } else {
    pair_by_name(folder, sequence);
  }
  read_calibration(folder / kCameraFile, sequence);
  const std::filesystem::path poses = folder / "poses.txt";
  if (std::filesystem::exists(poses)) sequence.ground_truth = read_trajectory(poses);
  return sequence;
}

}  // namespace surefield
