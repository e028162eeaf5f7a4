#include "engine/io/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "engine/io/file_names.h"
#include "engine/types/error.h"

namespace surefield {

bool file_exists(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) && !error;
}

bool folder_exists(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error) && !error;
}

std::vector<std::filesystem::path> list_folder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> entries;
  if (!folder_exists(folder)) return entries;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    entries.push_back(entry->path());
  if (error) throw InputError(folder, "cannot be read: " + error.message());
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return entries;
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw InputError(file, "no such file; check the path");
  if (error) throw InputError(file, "cannot be opened: " + error.message());
  if (std::filesystem::is_directory(status)) throw InputError(file, "is a folder, not a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file, "cannot be opened; check its permissions");
  std::ostringstream content;
  content << stream.rdbuf();
  if (stream.bad()) throw InputError(file, "cannot be read; check the disk");
  return std::move(content).str();
}

std::string read_regular_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  const bool other = std::filesystem::is_other(status);  // no file, folder or link
  if (!error && other) throw InputError(file, "is no file on a disk but a pipe or a device");
  return read_file(file);
}

void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!folder_exists(folder)) {
    throw InputError(file, "cannot be written: there is no folder " + folder.string() + "; create it first");
  }
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream stream(part, std::ios::binary | std::ios::trunc);
  if (!stream) throw InputError(file, "cannot be written; check the permissions of its folder");
  write(stream);
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(part, file, error);
  if (!stream || error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw InputError(
        file, error ? "cannot be written: " + error.message() : "cannot be written; is the disk full?");
  }
}

void sync_to_disk(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace surefield
