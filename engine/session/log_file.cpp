#include "engine/session/log_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// Writes all of it, as far as the disk takes it: a log that cannot be written on is no reason to stop.
void write_all(int descriptor, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = write(descriptor, bytes, count);
    if (written <= 0) return;
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

}  // namespace

LogFile::LogFile(const std::filesystem::path& file) : file_(file), descriptor_(open_file()) {
  if (descriptor_ < 0) throw InputError(file, "cannot be written: " + std::generic_category().message(errno));
}

LogFile::~LogFile() {
  close(descriptor_);
}

int LogFile::open_file() const {
  return open(file_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
}

void LogFile::restore() {
  const std::lock_guard lock(mutex_);
  if (file_exists(file_)) return;
  const int fresh = open_file();
  if (fresh < 0) return;
  std::array<char, 65536> buffer;
  off_t at = 0;
  for (ssize_t count = 0; (count = pread(descriptor_, buffer.data(), buffer.size(), at)) > 0; at += count)
    write_all(fresh, buffer.data(), static_cast<std::size_t>(count));
  close(descriptor_);
  descriptor_ = fresh;
}

void LogFile::moved_to(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  file_ = file;
}

void LogFile::sink_it_(const spdlog::details::log_msg& message) {
  spdlog::memory_buf_t text;
  formatter_->format(message, text);
  write_all(descriptor_, text.data(), text.size());
}

}  // namespace surefield
