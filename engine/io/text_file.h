#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace surefield {

/// One line of a text file that is not empty and not a comment.
struct TextLine {
  int number = 0;  ///< from 1
  std::string text;
};

/// The lines of a text file without those that are empty or start with '#', without the blanks around them.
/// Lines end as on any system, and a byte order mark is passed over. Throws InputError, also where the file
/// is no UTF-8 text.
std::vector<TextLine> read_lines(const std::filesystem::path& file);

/// The same without a header row: a first line whose first field begins with a letter, where that of the
/// second is a number.
std::vector<TextLine> read_rows(const std::filesystem::path& file);

/// The numbers of the lines that come right after a line with this comment, such as "# lost".
std::set<int> lines_after_comment(const std::filesystem::path& file, std::string_view comment);

/// The number that `text` is as a whole: decimal, with or without a sign; "nan" and "inf" are numbers.
/// nullopt where it is anything else.
std::optional<double> parse_number(std::string_view text);

/// The numbers in `text`, separated by blanks, or by commas or semicolons with or without blanks. nullopt
/// where anything else stands there.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// The same of a whole file, as of one that holds a matrix. Throws InputError where it cannot be read.
std::optional<std::vector<double>> read_numbers(const std::filesystem::path& file);

/// The fields of a row, separated in the same way; what stands between double quotes is one field.
std::vector<std::string> split_fields(std::string_view text);

/// Whether all of it is UTF-8, without characters that Unicode has not.
bool is_utf8(std::string_view text);

/// The text as one line that a terminal can show: control characters become blanks.
std::string printable(std::string text);

/// The rigid transform in 16 numbers, row by row. The rotation is made orthonormal to double precision; a
/// matrix that holds NaN or infinity stays as it is; nullopt when the matrix is no rigid transform within 1
/// percent.
std::optional<Eigen::Isometry3d> rigid_from_rows(const std::vector<double>& rows);

/// What one step of time stamps of this size is, seconds: clocks count seconds since 1970, and thousandths,
/// millionths or billionths of them. Smaller numbers are seconds.
double stamp_unit(double stamp);

}  // namespace surefield
