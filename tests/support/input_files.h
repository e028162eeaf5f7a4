#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "engine/types/error.h"

namespace surefield::test {

/// A fresh folder that goes away with the object.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name = "folder") {
    static int count = 0;
    root_ = std::filesystem::temp_directory_path() /
            ("surefield_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    path_ = root_ / name;
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(root_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Writes a file of the folder, with the folders above it. The file is always a new one: cutting an old one
  /// to nothing makes some file systems wait for the disk.
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::filesystem::remove(path_ / name);
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  std::filesystem::path root_;
  std::filesystem::path path_;
};

/// The message of the InputError that `action` throws; empty where it throws none. Messages must be one line.
template <typename Action>
std::string input_error(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    const std::string message = error.what();
    CHECK(message.find('\n') == std::string::npos);
    return message;
  }
  return {};
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A folder of the real clips, or an empty path (with a message) where they are not there.
inline std::filesystem::path real_clip(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(SUREFIELD_SOURCE_DIR "/../shared/data") / name;
  if (std::filesystem::is_directory(folder)) return folder;
  MESSAGE("skipped: the real clip ", name, " is not in ../shared/data");
  return {};
}

}  // namespace surefield::test
