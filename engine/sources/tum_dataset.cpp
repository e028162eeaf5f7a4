// TUM RGB-D: rgb.txt and depth.txt list "timestamp file"; groundtruth.txt is a trajectory.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/io/camera_json.h"
#include "engine/io/files.h"
#include "engine/io/json_file.h"
#include "engine/io/trajectory_file.h"
#include "engine/sources/camera_file.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kMaxStampDifference = 0.02;  // seconds between the colour and the depth image of a frame

/// One of the three cameras of the benchmark.
struct Calibration {
  const char* long_name;
  const char* short_name;
  Intrinsics intrinsics;
  std::vector<double> distortion;
};

const std::array<Calibration, 3>& known_calibrations() {
  static const std::array<Calibration, 3> calibrations = {{
      {"freiburg1",
       "fr1",
       {640, 480, 517.3, 516.5, 318.6, 255.3},
       {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}},
      {"freiburg2",
       "fr2",
       {640, 480, 520.9, 521.0, 325.1, 249.7},
       {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}},
      {"freiburg3", "fr3", {640, 480, 535.4, 539.2, 320.1, 247.6}, {}},
  }};
  return calibrations;
}

void read_own_camera(const std::filesystem::path& file, StoredSequence& sequence) {
  const RecordedCamera camera = read_camera_file(file);
  if (camera.intrinsics.width == 0) {
    throw InputError(file, "width and height are missing; in this layout they are needed");
  }
  sequence.intrinsics = camera.intrinsics;
  sequence.distortion = camera.distortion;
  sequence.depth_encoding.unit = camera.depth_unit;
}

/// Own recordings in this layout bring camera.yaml or cam_params.json; for the benchmark's sequences the
/// folder's name tells.
void read_tum_calibration(const std::filesystem::path& folder, StoredSequence& sequence) {
  if (std::filesystem::exists(folder / kCameraFile)) return read_own_camera(folder / kCameraFile, sequence);
  const std::filesystem::path file = folder / "cam_params.json";
  if (std::filesystem::exists(file)) {
    const JsonObject camera = JsonObject(file).object("camera");
    sequence.intrinsics = read_intrinsics(camera, "w", "h");
    sequence.depth_encoding.unit = 1 / camera.positive("scale");
    return;
  }
  for (const Calibration& known : known_calibrations()) {
    const bool named = sequence.name.find(known.long_name) != std::string::npos ||
                       sequence.name.find(known.short_name) != std::string::npos;
    if (!named) continue;
    sequence.intrinsics = known.intrinsics;
    sequence.distortion = known.distortion;
    sequence.depth_encoding.unit = kTumDepthUnit;
    return;
  }
  throw InputError(
      folder,
      "the camera is unknown: the folder's name has none of freiburg1, freiburg2, freiburg3 (or fr1, "
      "fr2, fr3), and there is no camera.yaml with width, height, fx, fy, cx, cy, depth_unit (nor "
      "cam_params.json with w, h, fx, fy, cx, cy, scale under \"camera\")");
}

struct ListedImage {
  double timestamp = 0;
  std::filesystem::path file;
};

std::vector<ListedImage> read_list(const std::filesystem::path& file) {
  std::vector<ListedImage> images;
  for (const TextLine& line : read_lines(file)) {
    const auto blank = line.text.find_first_of(" \t");
    const auto stamp = parse_numbers(line.text.substr(0, blank));
    if (blank == std::string::npos || !stamp || !std::isfinite(stamp->front())) {
      throw InputError(file, line.number, "expected \"timestamp file\"");
    }
    const auto name = line.text.find_first_not_of(" \t", blank);
    images.push_back({stamp->front(), file.parent_path() / line.text.substr(name)});
  }
  if (images.empty()) throw InputError(file, "lists no image");
  std::stable_sort(images.begin(), images.end(),
                   [](const ListedImage& a, const ListedImage& b) { return a.timestamp < b.timestamp; });
  return images;
}

/// The image of a sorted list that is nearest in time; the earlier one of two at the same distance.
const ListedImage& nearest(const std::vector<ListedImage>& images, double timestamp) {
  const auto after =
      std::lower_bound(images.begin(), images.end(), timestamp,
                       [](const ListedImage& image, double stamp) { return image.timestamp < stamp; });
  if (after == images.begin()) return *after;
  const auto before = std::prev(after);
  if (after == images.end()) return *before;
  return timestamp - before->timestamp <= after->timestamp - timestamp ? *before : *after;
}

}  // namespace

bool is_tum(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "rgb.txt") && std::filesystem::exists(folder / "depth.txt");
}

StoredSequence read_tum_sequence(const std::filesystem::path& folder, double depth_delay) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "tum";
  read_tum_calibration(folder, sequence);
  const std::vector<ListedImage> colours = read_list(folder / "rgb.txt");
  std::vector<ListedImage> depths = read_list(folder / "depth.txt");
  for (ListedImage& depth : depths) depth.timestamp += depth_delay;
  for (const ListedImage& colour : colours) {
    const ListedImage& depth = nearest(depths, colour.timestamp);
    if (std::abs(depth.timestamp - colour.timestamp) > kMaxStampDifference) continue;
    sequence.frames.push_back({colour.timestamp, colour.file, depth.file, depth.timestamp});
  }
  const std::size_t lonely = colours.size() - sequence.frames.size();
  if (sequence.frames.empty()) {
    throw InputError(folder, "no colour image of rgb.txt has a depth image in depth.txt within 0.02 s");
  }
  if (lonely > 0) {
    sequence.warnings.push_back(fmt::format(
        "{} of {} colour images have no depth image within 0.02 s and are left out", lonely, colours.size()));
  }
  const std::filesystem::path truth = folder / "groundtruth.txt";
  if (std::filesystem::exists(truth)) sequence.ground_truth = read_trajectory(truth);
  return sequence;
}

}  // namespace surefield
