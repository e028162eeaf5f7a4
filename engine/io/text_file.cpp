#include "engine/io/text_file.h"

#include <Eigen/SVD>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\f\v";
constexpr std::string_view kSeparators = " \t\r\n\f\v,;";
constexpr double kRigidTolerance = 0.01;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// The content of a text file without its byte order mark.
std::string read_text(const std::filesystem::path& file) {
  std::string text = read_file(file);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw InputError(file, "is UTF-16 text; save it as UTF-8");
  if (text.find('\0') != std::string::npos) throw InputError(file, "is no text file");
  return text;
}

/// Calls visit(number, text) for each line, from 1, without the blanks around it.
template <typename Visit>
void visit_lines(std::string_view rest, Visit visit) {
  for (int number = 1; !rest.empty(); ++number) {
    const auto end = std::min(rest.find_first_of("\r\n"), rest.size());
    visit(number, trimmed(rest.substr(0, end)));
    const bool two = rest.substr(end).starts_with("\r\n");
    rest.remove_prefix(std::min(end + (two ? 2 : 1), rest.size()));
  }
}

}  // namespace

std::vector<TextLine> read_lines(const std::filesystem::path& file) {
  std::vector<TextLine> lines;
  visit_lines(read_text(file), [&](int number, std::string_view text) {
    if (!text.empty() && text.front() != '#') lines.push_back({number, std::string(text)});
  });
  return lines;
}

std::set<int> lines_after_comment(const std::filesystem::path& file, std::string_view comment) {
  std::set<int> numbers;
  visit_lines(read_text(file), [&](int number, std::string_view text) {
    if (text == comment) numbers.insert(number + 1);
  });
  return numbers;
}

std::vector<TextLine> read_rows(const std::filesystem::path& file) {
  std::vector<TextLine> rows = read_lines(file);
  const auto first_field = [&](std::size_t row) {
    const auto fields = split_fields(rows[row].text);
    return fields.empty() ? std::string() : fields.front();
  };
  if (rows.size() < 2) return rows;
  const std::string title = first_field(0);
  const bool begins_with_letter = !title.empty() && std::isalpha(static_cast<unsigned char>(title.front()));
  if (begins_with_letter && !parse_number(title) && parse_number(first_field(1))) rows.erase(rows.begin());
  return rows;
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const auto first = text.find_first_not_of(kSeparators);
    if (first == std::string_view::npos) return numbers;
    text.remove_prefix(first);
    const std::string_view token = text.substr(0, text.find_first_of(kSeparators));
    const auto number = parse_number(token);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(token.size());
  }
}

std::optional<std::vector<double>> read_numbers(const std::filesystem::path& file) {
  return parse_numbers(read_text(file));
}

std::vector<std::string> split_fields(std::string_view text) {
  std::vector<std::string> fields;
  while (true) {
    const auto first = text.find_first_not_of(kSeparators);
    if (first == std::string_view::npos) return fields;
    text.remove_prefix(first);
    const bool quoted = text.front() == '"' && text.find('"', 1) != std::string_view::npos;
    const auto end = quoted ? text.find('"', 1) : std::min(text.find_first_of(kSeparators), text.size());
    fields.emplace_back(quoted ? text.substr(1, end - 1) : text.substr(0, end));
    text.remove_prefix(quoted ? end + 1 : end);
  }
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const auto first = static_cast<uint8_t>(text.front());
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    if (length == 0 || length > text.size()) return false;
    uint32_t character = length == 1 ? first : first & (0xff >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
      const auto next = static_cast<uint8_t>(text[i]);
      if ((next & 0xc0) != 0x80) return false;
      character = character << 6 | (next & 0x3f);
    }
    const bool overlong = (length == 3 && character < 0x800) || (length == 4 && character < 0x10000);
    const bool surrogate = character >= 0xd800 && character < 0xe000;
    if (overlong || surrogate || character > 0x10ffff) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string printable(std::string text) {
  for (char& c : text)
    if ((c >= 0 && c < ' ') || c == '\x7f') c = ' ';
  return text;
}

std::optional<Eigen::Isometry3d> rigid_from_rows(const std::vector<double>& rows) {
  if (rows.size() != 16) return std::nullopt;
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
  Eigen::Isometry3d rigid;
  rigid.matrix() = matrix;
  if (!matrix.allFinite()) return rigid;
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const bool orthonormal =
      (linear.transpose() * linear).isIdentity(kRigidTolerance) && linear.determinant() > 0;
  const bool affine =
      (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < kRigidTolerance;
  if (!orthonormal || !affine) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  rigid.linear() = svd.matrixU() * svd.matrixV().transpose();
  rigid.makeAffine();
  return rigid;
}

double stamp_unit(double stamp) {
  // The clocks of today count 1.7e9 seconds; a tenth of that leaves room for those that were set to an
  // earlier year.
  if (stamp > 1e17) return 1e-9;
  if (stamp > 1e14) return 1e-6;
  if (stamp > 1e11) return 1e-3;
  return 1;
}

}  // namespace surefield
