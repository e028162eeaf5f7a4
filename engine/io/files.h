#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace surefield {

/// The whole content of a file. Throws InputError when it is missing or cannot be read.
std::string read_file(const std::filesystem::path& file);

/// Writes a file through `write` so that it appears complete or not at all. Throws InputError when the folder
/// is missing, the disk is full, or the file cannot be written for another reason.
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);

/// One line of a text file that is not empty and not a comment.
struct TextLine {
  int number = 0;  ///< from 1
  std::string text;
};

/// The lines of a text file without those that are empty or start with '#'. Throws InputError.
std::vector<TextLine> read_lines(const std::filesystem::path& file);

/// The numbers in `text`, separated by blanks; "nan" and "inf" are numbers. nullopt where anything else
/// stands there.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// The rigid transform in 16 numbers, row by row. The rotation is made orthonormal to double precision; a
/// matrix that holds NaN or infinity stays as it is; nullopt when the matrix is no rigid transform within 1
/// percent.
std::optional<Eigen::Isometry3d> rigid_from_rows(const std::vector<double>& rows);

/// The files in `folder` that are named `prefix`, six digits, `suffix`, by their number.
std::map<int, std::filesystem::path> numbered_files(const std::filesystem::path& folder,
                                                    const std::string& prefix, const std::string& suffix);

/// The ending of the images in `folder` that are named `prefix`, six digits, `suffix`, ".png" or ".jpg":
/// `suffix` with what follows it; ".jpg" where there are none.
std::string image_suffix(const std::filesystem::path& folder, const std::string& prefix,
                         const std::string& suffix = "");

/// The images (.jpg, .jpeg, .png in any case) in `folder`, by their name without the extension; none where
/// there is no such folder.
std::map<std::string, std::filesystem::path> images_by_stem(const std::filesystem::path& folder);

}  // namespace surefield
