#pragma once

#include <filesystem>

namespace surefield {

/// Keeps other processes out of a folder as long as it lives; where this process is killed, they may enter.
class FolderLock {
 public:
  static constexpr const char* kName = ".lock";

  /// Takes the lock of a folder that exists. Throws InputError where another process has it, or where the
  /// folder cannot be written to. A file system without locks keeps nobody out.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Whether the folder still has this lock: not where it was removed, or made anew by somebody else.
  bool is_in_place() const;
  /// The folder has another name now.
  void moved_to(const std::filesystem::path& folder);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Whether a process has the lock of a folder.
bool is_locked(const std::filesystem::path& folder);

}  // namespace surefield
