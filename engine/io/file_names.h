#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace surefield {

/// The order in which people sort names: digits that stand together are a number, so 2 comes before 10.
bool natural_less(std::string_view a, std::string_view b);

/// The same as an order for containers.
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const { return natural_less(a, b); }
};

/// The extension in lower case, with its dot.
std::string lower_extension(const std::filesystem::path& file);

/// Whether a name is that of an image that can be read: it ends in .jpg, .png or another ending that OpenCV
/// knows, in any case, and does not start with a dot.
bool is_image_name(const std::filesystem::path& file);

/// The number that `text` is: digits alone, however many zeros lead; nullopt where it is anything else.
std::optional<int> whole_number(std::string_view text);

/// How a numbered file is named: `prefix`, digits, `suffix` (without the extension).
struct NumberedName {
  std::string prefix;
  std::string suffix = {};
};

/// The images in `folder` that are named so, by their number; of two with the same number the first in
/// natural order. None where there is no such folder.
std::map<int, std::filesystem::path> numbered_images(const std::filesystem::path& folder,
                                                     const NumberedName& name);

/// The files of another kind: `extension` with its dot, in any case.
std::map<int, std::filesystem::path> numbered_files(const std::filesystem::path& folder,
                                                    const NumberedName& name, const std::string& extension);

/// The images in `folder` by their name without the extension, in natural order; none where there is no such
/// folder.
std::map<std::string, std::filesystem::path, NaturalOrder> images_by_stem(
    const std::filesystem::path& folder);

/// The image that `file` means: itself where it is there; else the only one of the same name but for the
/// extension, the case, leading zeros, or backslashes for slashes. `file` again where there is none.
std::filesystem::path find_spelling(const std::filesystem::path& file);

}  // namespace surefield
