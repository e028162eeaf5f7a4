#include "engine/io/file_names.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "engine/io/files.h"

namespace surefield {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

std::string lower(std::string text) {
  for (char& c : text) c = lower(c);
  return text;
}

/// Takes the digits at the front of `text` off; without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// What the spellings of one name share: its small letters, and its numbers without leading zeros.
std::string spelling_key(const std::filesystem::path& file) {
  const std::string stem = lower(file.stem().string());
  std::string key;
  for (std::string_view rest = stem; !rest.empty();) {
    if (is_digit(rest.front())) {
      key += take_number(rest);
      key += ' ';
    } else {
      key += rest.front();
      rest.remove_prefix(1);
    }
  }
  return key;
}

/// The number in a name `prefix`, digits, `suffix`, extension; nullopt where it is named otherwise.
std::optional<int> number_in(const std::filesystem::path& file, const NumberedName& name) {
  const std::string stem = file.stem().string();
  if (stem.size() <= name.prefix.size() + name.suffix.size()) return std::nullopt;
  if (!stem.starts_with(name.prefix) || !stem.ends_with(name.suffix)) return std::nullopt;
  return whole_number(std::string_view(stem).substr(name.prefix.size(),
                                                    stem.size() - name.prefix.size() - name.suffix.size()));
}

template <typename Wanted>
std::map<int, std::filesystem::path> by_number(const std::filesystem::path& folder, const NumberedName& name,
                                               Wanted wanted) {
  std::map<int, std::filesystem::path> files;
  for (const std::filesystem::path& file : list_folder(folder)) {
    if (!wanted(file)) continue;
    if (const auto number = number_in(file, name)) files.try_emplace(*number, file);
  }
  return files;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view number_a = take_number(a), number_b = take_number(b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else {
      if (a.front() != b.front())
        return static_cast<unsigned char>(a.front()) < static_cast<unsigned char>(b.front());
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // they differ in leading zeros at most
}

std::string lower_extension(const std::filesystem::path& file) {
  return lower(file.extension().string());
}

bool is_image_name(const std::filesystem::path& file) {
  if (file.filename().string().starts_with('.')) return false;  // notes of a desktop beside each image
  constexpr std::array kExtensions = {".jpg", ".jpeg", ".png", ".tif", ".tiff",
                                      ".bmp", ".webp", ".pgm", ".ppm"};
  const std::string extension = lower_extension(file);
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

std::optional<int> whole_number(std::string_view text) {
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_digit)) return std::nullopt;
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

std::map<int, std::filesystem::path> numbered_images(const std::filesystem::path& folder,
                                                     const NumberedName& name) {
  return by_number(folder, name, is_image_name);
}

std::map<int, std::filesystem::path> numbered_files(const std::filesystem::path& folder,
                                                    const NumberedName& name, const std::string& extension) {
  return by_number(folder, name, [&](const auto& file) { return lower_extension(file) == extension; });
}

std::map<std::string, std::filesystem::path, NaturalOrder> images_by_stem(
    const std::filesystem::path& folder) {
  std::map<std::string, std::filesystem::path, NaturalOrder> images;
  for (const std::filesystem::path& file : list_folder(folder))
    if (is_image_name(file)) images.try_emplace(file.stem().string(), file);
  return images;
}

std::filesystem::path find_spelling(const std::filesystem::path& file) {
  if (file_exists(file)) return file;
  std::string slashes = file.string();
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const std::filesystem::path path(slashes);
  if (file_exists(path)) return path;
  const std::string wanted = spelling_key(path);
  std::filesystem::path found;
  for (const std::filesystem::path& other : list_folder(path.parent_path())) {
    if (!is_image_name(other) || spelling_key(other) != wanted) continue;
    if (!found.empty()) return file;  // which of the two nobody knows
    found = other;
  }
  return found.empty() ? file : found;
}

}  // namespace surefield
