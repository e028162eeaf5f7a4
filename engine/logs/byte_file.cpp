#include "engine/logs/byte_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/types/error.h"

namespace surefield {

ByteFile::ByteFile(const std::filesystem::path& file) : path_(file) {
  // Whoever opens a pipe waits until somebody writes to it.
  descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) throw InputError(file, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(descriptor_);
    throw InputError(file, "is no file on a disk");
  }
  size_ = static_cast<uint64_t>(status.st_size);
}

ByteFile::~ByteFile() {
  close(descriptor_);
}

std::string ByteFile::read(uint64_t at, uint64_t count) const {
  if (at > size_ || count > size_ - at) throw InputError(path_, "ends too early; it may have been cut off");
  std::string bytes(count, '\0');
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = pread(descriptor_, bytes.data() + done, count - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw InputError(path_, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) throw InputError(path_, "has become shorter while it was read");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::string ByteFile::read_up_to(uint64_t at, uint64_t count) const {
  if (at >= size_) return {};
  return read(at, std::min(count, size_ - at));
}

}  // namespace surefield
