#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace surefield {

/// A file on a disk that is read in places, by any threads at once.
class ByteFile {
 public:
  /// Throws InputError where there is no such file, or it is no regular one or cannot be opened.
  explicit ByteFile(const std::filesystem::path& file);
  ~ByteFile();
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Bytes, as they were when the file was opened.
  uint64_t size() const { return size_; }

  /// The `count` bytes from `at` on. Throws InputError where the file ends before, and then takes no memory
  /// for them.
  std::string read(uint64_t at, uint64_t count) const;

  /// The same, of what there is of them.
  std::string read_up_to(uint64_t at, uint64_t count) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
};

}  // namespace surefield
