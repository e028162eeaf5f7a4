#include "engine/io/bundler_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "engine/io/files.h"
#include "engine/io/pose_numbers.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kLinesPerCamera = 5;  // focal length and distortion; three rows of R; t

std::vector<double> numbers_of(const std::filesystem::path& file, const TextLine& line, std::size_t count) {
  auto numbers = parse_numbers(line.text);
  if (!numbers || numbers->size() != count) {
    throw InputError(file, line.number,
                     fmt::format("expected {} numbers, as in Bundler's bundle.out", count));
  }
  return *std::move(numbers);
}

/// How many cameras the list names. It cannot name more than there are lines for.
std::size_t camera_count(const std::filesystem::path& file, const std::vector<TextLine>& lines) {
  if (lines.empty()) throw InputError(file, "holds no camera");
  const double count = numbers_of(file, lines.front(), 2)[0];
  const auto room = static_cast<double>((lines.size() - 1) / kLinesPerCamera);
  if (!(count >= 0 && count <= room && count == std::floor(count))) {
    throw InputError(
        file, lines.front().number,
        fmt::format("names {:g} cameras, there are lines for {:g}; the file is cut off", count, room));
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

Trajectory read_bundler(const std::filesystem::path& file) {
  const std::vector<TextLine> lines = read_lines(file);
  const std::size_t count = camera_count(file, lines);
  Trajectory trajectory;
  for (std::size_t camera = 0; camera < count; ++camera) {
    const TextLine* block = &lines[1 + camera * kLinesPerCamera];
    std::vector<double> matrix;
    const std::vector<double> t = numbers_of(file, block[4], 3);
    for (std::size_t row = 0; row < 3; ++row) {
      for (double value : numbers_of(file, block[1 + row], 3)) matrix.push_back(value);
      matrix.push_back(t[row]);
    }
    StampedPose pose{static_cast<double>(camera)};
    if (numbers_of(file, block[0], 3)[0] == 0) {
      pose.camera_to_world.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
    } else {
      pose.camera_to_world = pose_of_looking_back(pose_from_rows({file, block[1].number}, matrix).inverse());
    }
    trajectory.push_back(pose);
  }
  return trajectory;
}

}  // namespace surefield
