#include "engine/io/files.h"

#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\f\v";
constexpr double kRigidTolerance = 0.01;

}  // namespace

std::string read_file(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw InputError(file, "is a folder, a file is needed here");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    const bool exists = std::filesystem::exists(file);
    throw InputError(file,
                     exists ? "cannot be opened; check its permissions" : "no such file; check the path");
  }
  std::ostringstream content;
  content << stream.rdbuf();
  if (stream.bad()) throw InputError(file, "cannot be read; check the disk");
  return std::move(content).str();
}

void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(file, "cannot be written: there is no folder " + folder.string() + "; create it first");
  }
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream stream(part, std::ios::binary | std::ios::trunc);
  if (!stream) throw InputError(file, "cannot be written; check the permissions of its folder");
  write(stream);
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(part, file, error);
  if (!stream || error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw InputError(
        file, error ? "cannot be written: " + error.message() : "cannot be written; is the disk full?");
  }
}

std::vector<TextLine> read_lines(const std::filesystem::path& file) {
  std::istringstream content(read_file(file));
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(content, text); ++number) {
    const auto first = text.find_first_not_of(kBlanks);
    if (first == std::string::npos || text[first] == '#') continue;
    const auto last = text.find_last_not_of(kBlanks);
    lines.push_back({number, text.substr(first, last - first + 1)});
  }
  return lines;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const auto first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return numbers;
    text.remove_prefix(first);
    const std::string_view token = text.substr(0, text.find_first_of(kBlanks));
    double number = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), number);
    if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(token.size());
  }
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

std::map<int, std::filesystem::path> numbered_files(const std::filesystem::path& folder,
                                                    const std::string& prefix, const std::string& suffix) {
  constexpr std::size_t kDigits = 6;
  std::map<int, std::filesystem::path> files;
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() != prefix.size() + kDigits + suffix.size()) continue;
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    const std::string digits = name.substr(prefix.size(), kDigits);
    if (!std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; })) continue;
    files[std::stoi(digits)] = entry.path();
  }
  return files;
}

std::string image_suffix(const std::filesystem::path& folder, const std::string& prefix,
                         const std::string& suffix) {
  return suffix + (numbered_files(folder, prefix, suffix + ".png").empty() ? ".jpg" : ".png");
}

std::map<std::string, std::filesystem::path> images_by_stem(const std::filesystem::path& folder) {
  std::map<std::string, std::filesystem::path> images;
  if (!std::filesystem::is_directory(folder)) return images;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
    if (extension != ".jpg" && extension != ".jpeg" && extension != ".png") continue;
    images[entry.path().stem().string()] = entry.path();
  }
  return images;
}

}  // namespace surefield
