#include "engine/io/trajectory_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "engine/io/bundler_file.h"
#include "engine/io/files.h"
#include "engine/io/number_table.h"
#include "engine/io/pose_numbers.h"
#include "engine/io/text_file.h"
#include "engine/io/trajectory_file.h"
#include "engine/io/transforms_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

using Path = std::filesystem::path;
using Numbers = std::span<const double>;

constexpr std::size_t kQuaternionPose = 7;  // tx ty tz qx qy qz qw
constexpr std::size_t kEurocColumns = 17;   // a stamp, a pose, velocities and biases of its sensors
constexpr const char* kKnownRows =
    "8 or 9 numbers (stamp, position, quaternion), 7 (without the stamp), 12 (KITTI), 16, 13 or 17 (matrix, "
    "with a stamp before it), 17 with commas (EuRoC), or a 4 x 4 matrix in four lines";

/// Which of the columns hold a quaternion's w: the first of the four, the last, or nobody says.
enum class ScalarPlace { Unknown, First, Last };

ScalarPlace scalar_place(const std::vector<std::string>& names) {
  const auto find = [&](char axis) {
    return std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return name.starts_with('q') && name.size() > 1 && name.find(axis, 1) != std::string::npos &&
             name.find_first_of("wxyz", 1) == name.find(axis, 1);
    });
  };
  const auto w = find('w'), x = find('x');
  if (w == names.end() || x == names.end()) return ScalarPlace::Unknown;
  return w < x ? ScalarPlace::First : ScalarPlace::Last;
}

bool ends_as_matrix(Numbers row) {
  return row.size() >= 4 && row[row.size() - 1] == 1 && row[row.size() - 2] == 0 &&
         row[row.size() - 3] == 0 && row[row.size() - 4] == 0;
}

/// The median step between stamps, seconds if those are seconds.
double usual_step(const Trajectory& poses) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses.size(); ++i)
    steps.push_back(std::abs(poses[i].timestamp - poses[i - 1].timestamp));
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Stamps of clocks that count nano-, micro- or milliseconds become seconds. Seconds since 1970 have ten
/// digits, and no camera waits for a quarter of an hour between its frames.
void to_seconds(Trajectory& poses) {
  double largest = 0;
  for (const StampedPose& pose : poses) largest = std::max(largest, std::abs(pose.timestamp));
  const double step = usual_step(poses);
  const double unit = largest > 1e17 || step > 1e6   ? 1e-9
                      : largest > 1e14 || step > 1e3 ? 1e-6
                      : largest > 1e11               ? 1e-3
                                                     : 1;
  for (StampedPose& pose : poses) pose.timestamp *= unit;
}

/// Reads the poses of one file from its table.
class TableReader {
 public:
  TableReader(const Path& file, const NumberTable& table, std::optional<TrajectoryFormat> format)
      : file_(file), table_(table), columns_(table.rows.front().values.size()) {
    result_.format = format.value_or(recognised());
  }

  TrajectoryFile read() {
    if (result_.format == TrajectoryFormat::Matrices && columns_ <= 4) {
      read_blocks();
    } else {
      for (const NumberRow& row : table_.rows) add(row);
      if (!result_.numbered) to_seconds(result_.poses);
    }
    return std::move(result_);
  }

 private:
  TrajectoryFormat recognised() const {
    const NumberRow& first = table_.rows.front();
    if (columns_ == 12) return TrajectoryFormat::Kitti;
    if (columns_ <= 4 || columns_ == 13 || columns_ == 16) return TrajectoryFormat::Matrices;
    if (columns_ == kEurocColumns && ends_as_matrix(first.values)) return TrajectoryFormat::Matrices;
    if (columns_ == kEurocColumns) return TrajectoryFormat::Euroc;
    const ScalarPlace place = scalar_place(table_.names);
    if (columns_ < kQuaternionPose || (columns_ > 9 && place == ScalarPlace::Unknown)) {
      throw InputError(file_, first.line,
                       fmt::format("has {} numbers; of trajectories are known: {}", columns_, kKnownRows));
    }
    if (place != ScalarPlace::Unknown)
      return place == ScalarPlace::First ? TrajectoryFormat::Euroc : TrajectoryFormat::Tum;
    const bool counts_nanoseconds = first.values[0] > 1e17;
    return table_.has_commas && counts_nanoseconds ? TrajectoryFormat::Euroc : TrajectoryFormat::Tum;
  }

  [[noreturn]] void refuse(const NumberRow& row, const std::string& expected) const {
    throw InputError(file_, row.line,
                     fmt::format("has {} numbers; the format {} wants {} (--trajectory-format names another)",
                                 row.values.size(), name_of(result_.format), expected));
  }

  void add(const NumberRow& row) {
    if (row.values.size() != columns_) {
      throw InputError(file_, row.line,
                       fmt::format("has {} numbers, but the first row has {}", row.values.size(), columns_));
    }
    switch (result_.format) {
      case TrajectoryFormat::Kitti:
        if (columns_ != 12) refuse(row, "12");
        return add_rows(row, row.values);
      case TrajectoryFormat::Matrices:
        if (columns_ != 12 && columns_ != 13 && columns_ != 16 && columns_ != 17)
          refuse(row, "12 or 16, with a stamp before them or without, or a matrix in four lines");
        return add_rows(row, row.values);
      default:
        return add_quaternion(row);
    }
  }

  /// 12 or 16 numbers, behind a stamp where they are one more.
  void add_rows(const NumberRow& row, Numbers numbers) {
    const bool stamped = numbers.size() == 13 || numbers.size() == 17;
    push(row, stamped ? std::optional(numbers[0]) : std::nullopt,
         pose_from_rows({file_, row.line}, stamped ? numbers.subspan(1) : numbers));
  }

  void add_quaternion(const NumberRow& row) {
    if (columns_ < kQuaternionPose) refuse(row, "8: a stamp, a position and a quaternion");
    const bool stamped = columns_ > kQuaternionPose;
    const Numbers n = Numbers(row.values).subspan(stamped ? 1 : 0, kQuaternionPose);
    std::array<double, kQuaternionPose> pose = {n[0], n[1], n[2], n[3], n[4], n[5], n[6]};
    if (result_.format == TrajectoryFormat::Euroc) pose = {n[0], n[1], n[2], n[4], n[5], n[6], n[3]};
    push(row, stamped ? std::optional(row.values[0]) : std::nullopt,
         pose_from_quaternion({file_, row.line}, pose));
  }

  /// Matrices in four lines each; a line of fewer numbers may stand before each of them, as in Redwood's
  /// logs.
  void read_blocks() {
    std::vector<double> numbers;
    for (const NumberRow& row : table_.rows) {
      if (row.values.size() < 4 && numbers.empty()) continue;
      if (row.values.size() != 4)
        throw InputError(
            file_, row.line,
            fmt::format("has {} numbers; a row of a 4 x 4 matrix is expected", row.values.size()));
      numbers.insert(numbers.end(), row.values.begin(), row.values.end());
      if (numbers.size() < 16) continue;
      push(row, std::nullopt, pose_from_rows({file_, row.line}, numbers));
      numbers.clear();
    }
    if (!numbers.empty()) throw InputError(file_, "ends within a matrix; the file is cut off");
  }

  void push(const NumberRow& row, std::optional<double> stamp, const Eigen::Isometry3d& pose) {
    if (stamp && !std::isfinite(*stamp)) throw InputError(file_, row.line, "its time stamp is no number");
    result_.numbered = !stamp;
    result_.poses.push_back(
        {stamp.value_or(static_cast<double>(result_.poses.size())), pose, lost_.contains(row.line)});
  }

  const Path& file_;
  const NumberTable& table_;
  std::size_t columns_;
  const std::set<int> lost_ = lines_after_comment(file_, kLostComment);
  TrajectoryFile result_;
};

/// The format that the start of a file shows where it is no table of numbers.
std::optional<TrajectoryFormat> format_by_start(const std::string& content) {
  const auto first = content.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string::npos) return std::nullopt;
  const std::string_view start = std::string_view(content).substr(first);
  if (start.starts_with('{')) return TrajectoryFormat::Transforms;
  if (start.starts_with("# Bundle file")) return TrajectoryFormat::Bundler;
  return std::nullopt;
}

TrajectoryFile read_table(const Path& file, std::optional<TrajectoryFormat> format) {
  const NumberTable table = read_number_table(file);
  if (table.rows.empty()) throw InputError(file, "holds no pose");
  return TableReader(file, table, format).read();
}

}  // namespace

const std::map<std::string, TrajectoryFormat>& trajectory_formats() {
  static const std::map<std::string, TrajectoryFormat> formats = {
      {"tum", TrajectoryFormat::Tum},         {"kitti", TrajectoryFormat::Kitti},
      {"euroc", TrajectoryFormat::Euroc},     {"matrices", TrajectoryFormat::Matrices},
      {"bundler", TrajectoryFormat::Bundler}, {"transforms", TrajectoryFormat::Transforms}};
  return formats;
}

std::string name_of(TrajectoryFormat format) {
  for (const auto& [name, value] : trajectory_formats())
    if (value == format) return name;
  return {};
}

TrajectoryFile read_any_trajectory(const Path& file, const TrajectoryReading& reading) {
  const auto format = reading.format ? reading.format : format_by_start(read_file(file));
  TrajectoryFile result;
  if (format == TrajectoryFormat::Bundler || format == TrajectoryFormat::Transforms) {
    result = {format == TrajectoryFormat::Bundler ? read_bundler(file) : read_transforms(file), *format,
              true};
  } else {
    result = read_table(file, format);
  }
  if (result.poses.empty()) throw InputError(file, "holds no pose");
  if (!result.numbered || reading.stamps.empty()) return result;
  if (reading.stamps.size() != result.poses.size()) {
    throw InputError(file, fmt::format("has {} poses without stamps for {} frames; which belongs to which is "
                                       "unknown: give a pose for each frame, or stamps",
                                       result.poses.size(), reading.stamps.size()));
  }
  for (std::size_t i = 0; i < result.poses.size(); ++i) result.poses[i].timestamp = reading.stamps[i];
  result.numbered = false;
  return result;
}

std::vector<double> read_stamps(const Path& file) {
  std::vector<double> stamps;
  for (const TextLine& line : read_lines(file)) {
    const auto number = parse_numbers(line.text.substr(0, line.text.find_first_of(" \t,;")));
    if (!number || number->empty() || !std::isfinite(number->front())) {
      throw InputError(file, line.number, "does not begin with a time stamp");
    }
    stamps.push_back(number->front());
  }
  if (stamps.empty()) throw InputError(file, "holds no time stamp");
  return stamps;
}

}  // namespace surefield
