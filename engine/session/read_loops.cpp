// loops.csv read back.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/session/loop_table.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::array kLoopColumns = {"from", "to", "accepted", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
constexpr const char* kInformationColumn = "information";
constexpr std::array kFigureColumns = {"similarity", "overlap", "see_through", "correction_cm",
                                       "correction_deg"};
constexpr std::size_t kInformationNumbers = 21;  // the upper triangle by rows

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    const auto first = cell.find_first_not_of(" \t\"");
    cells.push_back(
        first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(" \t\"") - first + 1));
  }
  return cells;
}

class LoopReader {
 public:
  LoopReader(const std::filesystem::path& file, const TextLine& names) : file_(file) {
    const std::vector<std::string> cells = cells_of(names.text);
    for (std::size_t i = 0; i < kLoopColumns.size(); ++i) {
      const auto place = find(cells, kLoopColumns[i]);
      if (!place)
        throw InputError(file, names.number, fmt::format("names no column \"{}\"", kLoopColumns[i]));
      places_[i] = *place;
    }
    information_ = find(cells, kInformationColumn);
    why_ = find(cells, "why");
    for (std::size_t i = 0; i < kFigureColumns.size(); ++i) figures_[i] = find(cells, kFigureColumns[i]);
  }

  StoredLoop parse(const TextLine& line) const {
    const std::vector<std::string> cells = cells_of(line.text);
    std::array<double, kLoopColumns.size()> values{};
    for (std::size_t i = 0; i < kLoopColumns.size(); ++i) {
      const auto value = places_[i] < cells.size() ? parse_number(cells[places_[i]]) : std::nullopt;
      if (!value)
        throw InputError(file_, line.number, fmt::format("has no number in column \"{}\"", kLoopColumns[i]));
      values[i] = *value;
    }
    const auto [from, to, accepted, tx, ty, tz, qx, qy, qz, qw] = values;
    StoredLoop loop;
    loop.measured.from = static_cast<int>(from);
    loop.measured.to = static_cast<int>(to);
    loop.accepted = accepted != 0;
    describe(loop, cells);
    if (!loop.accepted) return loop;
    const Eigen::Quaterniond rotation(qw, qx, qy, qz);
    if (!(rotation.norm() > 0.9 && rotation.norm() < 1.1))
      throw InputError(file_, line.number, "qx, qy, qz, qw are no rotation");
    loop.measured.pose.linear() = rotation.normalized().toRotationMatrix();
    loop.measured.pose.translation() = Eigen::Vector3d(tx, ty, tz);
    if (information_) loop.measured.information = information_of(line, cells);
    return loop;
  }

 private:
  static std::optional<std::size_t> find(const std::vector<std::string>& cells, const char* name) {
    const auto found = std::find(cells.begin(), cells.end(), name);
    if (found == cells.end()) return std::nullopt;
    return static_cast<std::size_t>(found - cells.begin());
  }

  /// What is there for people to read.
  void describe(StoredLoop& loop, const std::vector<std::string>& cells) const {
    const auto figure = [&](std::size_t i) {
      if (!figures_[i] || *figures_[i] >= cells.size()) return StoredLoop::kUnsaid;
      return parse_number(cells[*figures_[i]]).value_or(StoredLoop::kUnsaid);
    };
    if (why_ && *why_ < cells.size()) loop.why = cells[*why_];
    loop.similarity = figure(0);
    loop.overlap = figure(1);
    loop.see_through = figure(2);
    loop.correction_m = figure(3) / 100;
    loop.correction_deg = figure(4);
  }

  Matrix6 information_of(const TextLine& line, const std::vector<std::string>& cells) const {
    const auto numbers = *information_ < cells.size() ? parse_numbers(cells[*information_]) : std::nullopt;
    if (!numbers || numbers->size() != kInformationNumbers)
      throw InputError(file_, line.number,
                       fmt::format("has no {} numbers in column \"{}\": the upper triangle, by rows",
                                   kInformationNumbers, kInformationColumn));
    Matrix6 information;
    auto number = numbers->begin();
    for (int row = 0; row < information.rows(); ++row)
      for (int column = row; column < information.cols(); ++column)
        information(row, column) = information(column, row) = *number++;
    if (!information.allFinite())
      throw InputError(file_, line.number,
                       fmt::format("has a number in column \"{}\" that is not finite", kInformationColumn));
    return information;
  }

  std::filesystem::path file_;
  std::array<std::size_t, kLoopColumns.size()> places_{};
  std::optional<std::size_t> information_, why_;
  std::array<std::optional<std::size_t>, kFigureColumns.size()> figures_{};
};

}  // namespace

std::vector<StoredLoop> read_loops(const std::filesystem::path& file) {
  if (!file_exists(file)) throw InputError(file, "no such file; only runs that look for loops write one");
  const std::vector<TextLine> lines = read_lines(file);
  if (lines.empty()) throw InputError(file, "is empty; its first line names the columns");
  const LoopReader reader(file, lines.front());
  std::vector<StoredLoop> loops;
  for (std::size_t i = 1; i < lines.size(); ++i) loops.push_back(reader.parse(lines[i]));
  return loops;
}

}  // namespace surefield
