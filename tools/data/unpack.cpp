#include "tools/data/unpack.h"

#include <archive.h>
#include <archive_entry.h>

#include <memory>
#include <string>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kBlock = 1 << 18;

struct FreeReader {
  void operator()(archive* reader) const { archive_read_free(reader); }
};
struct FreeWriter {
  void operator()(archive* writer) const { archive_write_free(writer); }
};

std::string problem_of(archive* source) {
  const char* text = archive_error_string(source);
  return text ? text : "unknown error";
}

void copy_data(archive* reader, archive* writer, const std::filesystem::path& file) {
  const void* bytes = nullptr;
  std::size_t count = 0;
  la_int64_t offset = 0;
  while (true) {
    const int read = archive_read_data_block(reader, &bytes, &count, &offset);
    if (read == ARCHIVE_EOF) return;
    if (read < ARCHIVE_WARN) throw InputError(file, "is damaged: " + problem_of(reader));
    if (archive_write_data_block(writer, bytes, count, offset) < ARCHIVE_WARN) {
      throw InputError(file, "cannot be unpacked: " + problem_of(writer));
    }
  }
}

}  // namespace

bool unpack(const std::filesystem::path& archive_file, const std::filesystem::path& folder,
            const TransferProgress& progress) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder, "cannot be created: " + error.message());
  const std::unique_ptr<archive, FreeReader> reader(archive_read_new());
  archive_read_support_format_all(reader.get());
  archive_read_support_filter_all(reader.get());
  if (archive_read_open_filename(reader.get(), archive_file.c_str(), kBlock) != ARCHIVE_OK) {
    throw InputError(archive_file, "is no archive that can be read: " + problem_of(reader.get()));
  }
  const std::unique_ptr<archive, FreeWriter> writer(archive_write_disk_new());
  archive_write_disk_set_options(
      writer.get(), ARCHIVE_EXTRACT_TIME | ARCHIVE_EXTRACT_SECURE_NODOTDOT | ARCHIVE_EXTRACT_SECURE_SYMLINKS);
  const uint64_t total = std::filesystem::file_size(archive_file);
  archive_entry* entry = nullptr;
  while (true) {
    const int next = archive_read_next_header(reader.get(), &entry);
    if (next == ARCHIVE_EOF) return true;
    if (next < ARCHIVE_WARN) throw InputError(archive_file, "is damaged: " + problem_of(reader.get()));
    const std::filesystem::path name = archive_entry_pathname(entry);
    if (name.is_absolute() || archive_entry_hardlink(entry)) {
      throw InputError(archive_file, "holds " + name.string() + ", which leads out of its folder");
    }
    archive_entry_set_pathname(entry, (folder / name).c_str());
    if (archive_write_header(writer.get(), entry) < ARCHIVE_WARN) {
      throw InputError(archive_file, "cannot be unpacked: " + problem_of(writer.get()));
    }
    copy_data(reader.get(), writer.get(), archive_file);
    if (archive_write_finish_entry(writer.get()) < ARCHIVE_WARN) {
      throw InputError(archive_file, "cannot be unpacked: " + problem_of(writer.get()));
    }
    const auto done = static_cast<uint64_t>(archive_filter_bytes(reader.get(), -1));
    if (progress && !progress(done, total)) return false;
  }
}

}  // namespace surefield
