#include "tests/fuzz/harness.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>

namespace surefield::fuzz {

namespace {

/// A folder under /dev/shm, else among the temporary files.
class Folder {
 public:
  Folder() {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    const std::filesystem::path memory = "/dev/shm";
    const auto root = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = root / ("surefield_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

const std::filesystem::path& folder() {
  static const Folder folder;
  return folder.path();
}

std::filesystem::path write_input(const std::string& name, const uint8_t* data, std::size_t size) {
  const std::filesystem::path file = folder() / name;
  std::filesystem::create_directories(file.parent_path());
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (!stream || std::fwrite(data, 1, size, stream) != size || std::fclose(stream) != 0) std::abort();
  return file;
}

}  // namespace surefield::fuzz
