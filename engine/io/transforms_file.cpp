#include "engine/io/transforms_file.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/camera_json.h"
#include "engine/io/files.h"
#include "engine/io/pose_numbers.h"
#include "engine/io/text_file.h"

namespace surefield {

namespace {

/// The last number in the name of an image, its extension aside.
std::optional<double> number_in(const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  const auto last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  const auto before = stem.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  const auto numbers = parse_numbers(stem.substr(first, last - first + 1));
  return numbers ? std::optional(numbers->front()) : std::nullopt;
}

std::string text_of(const JsonObject& object, const std::string& key) {
  if (!object.at(key).is_string()) object.fail(key, "must be a text");
  return object.at(key).get<std::string>();
}

}  // namespace

Trajectory read_transforms(const std::filesystem::path& file) {
  struct Frame {
    std::optional<double> number;
    Eigen::Isometry3d pose;
  };
  std::vector<Frame> frames;
  bool are_numbered = true;
  for (const JsonObject& each : JsonObject(file).objects("frames")) {
    const auto number = number_in(text_of(each, "file_path"));
    are_numbered = are_numbered && number;
    frames.push_back({number, pose_of_looking_back(read_rigid(each, "transform_matrix"))});
  }
  if (are_numbered) {
    std::stable_sort(frames.begin(), frames.end(),
                     [](const Frame& a, const Frame& b) { return *a.number < *b.number; });
  }
  Trajectory trajectory;
  for (const Frame& frame : frames)
    trajectory.push_back({static_cast<double>(trajectory.size()), frame.pose});
  return trajectory;
}

}  // namespace surefield
