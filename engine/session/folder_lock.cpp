#include "engine/session/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "engine/types/error.h"

namespace surefield {

FolderLock::FolderLock(const std::filesystem::path& folder) : file_(folder / kName) {
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw InputError(folder, "cannot be written to: " + std::generic_category().message(errno));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw InputError(folder, "another run is writing there; wait until it has ended, or give another folder");
}

FolderLock::~FolderLock() {
  std::error_code ignored;
  if (is_in_place()) std::filesystem::remove(file_, ignored);
  close(descriptor_);
}

bool FolderLock::is_in_place() const {
  struct stat own {
  }, there{};
  return fstat(descriptor_, &own) == 0 && stat(file_.c_str(), &there) == 0 && own.st_dev == there.st_dev &&
         own.st_ino == there.st_ino;
}

void FolderLock::moved_to(const std::filesystem::path& folder) {
  file_ = folder / kName;
}

bool is_locked(const std::filesystem::path& folder) {
  const int descriptor = open((folder / FolderLock::kName).c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool locked = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return locked;
}

}  // namespace surefield
