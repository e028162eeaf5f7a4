#include "tools/data/unpack.h"

#include <archive.h>
#include <archive_entry.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kBlock = 1 << 18;
constexpr uint64_t kMostExpansion = 50;                  // images and depth hardly compress, meshes fivefold
constexpr uint64_t kAlwaysAllowed = uint64_t{64} << 20;  // bytes, however small the archive is
constexpr uint64_t kBytesPerEntry = 4096;                // that even an empty file takes

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

InputError damaged(const std::filesystem::path& file, archive* reader) {
  return {file, "is damaged: " + problem_of(reader) + "; remove it, and fetch it again"};
}

/// Counts what an archive grows to, and refuses what exceeds its bound.
class SizeBound {
 public:
  SizeBound(const std::filesystem::path& file, uint64_t most) : file_(file), most_(most) {}

  /// Of an entry: it takes space in the folder even where it is empty.
  void begin() {
    done_ += entry_ + kBytesPerEntry;
    entry_ = 0;
    reach(0);
  }
  /// The entry has, or is said to have, so many bytes.
  void reach(uint64_t size) {
    entry_ = std::max(entry_, size);
    if (size <= most_ && done_ + entry_ <= most_) return;
    throw InputError(file_,
                     fmt::format("unpacks to more than {:.0f} MB, which is more than the disk has free, or "
                                 "than {} times its own size; it is refused",
                                 static_cast<double>(most_) / 1e6, kMostExpansion));
  }

 private:
  const std::filesystem::path& file_;
  uint64_t most_;
  uint64_t done_ = 0, entry_ = 0;
};

uint64_t usual_bound(const std::filesystem::path& archive, const std::filesystem::path& folder) {
  const std::filesystem::space_info space = std::filesystem::space(folder);
  return std::min<uint64_t>(space.available,
                            std::max(kAlwaysAllowed, kMostExpansion * std::filesystem::file_size(archive)));
}

void copy_data(archive* reader, archive* writer, const std::filesystem::path& file, SizeBound& bound) {
  const void* bytes = nullptr;
  std::size_t count = 0;
  la_int64_t offset = 0;
  while (true) {
    const int read = archive_read_data_block(reader, &bytes, &count, &offset);
    if (read == ARCHIVE_EOF) return;
    if (read < ARCHIVE_WARN) throw damaged(file, reader);
    bound.reach(static_cast<uint64_t>(offset) + count);
    if (archive_write_data_block(writer, bytes, count, offset) < ARCHIVE_WARN) {
      throw InputError(file, "cannot be unpacked: " + problem_of(writer));
    }
  }
}

/// Whether a relative path stays in the folder that it starts `depth` folders below. It may only begin with
/// "..": behind the name of a link it could lead anywhere.
bool stays_inside(const std::filesystem::path& path, long depth) {
  bool has_name = false;
  for (const std::filesystem::path& part : path) {
    if (part == ".") continue;
    if (part == "..") {
      if (has_name || --depth < 0) return false;
    } else {
      has_name = true;
    }
  }
  return !path.is_absolute();
}

/// Refuses entries that lead out of the folder, and all that is neither file, folder nor link.
void check_entry(const std::filesystem::path& file, archive_entry* entry) {
  const std::filesystem::path name = archive_entry_pathname(entry) ? archive_entry_pathname(entry) : "";
  const char* hard = archive_entry_hardlink(entry);
  const char* soft = archive_entry_symlink(entry);
  const auto folders = std::distance(name.begin(), name.end()) - 1;
  const bool inside = !name.empty() && stays_inside(name, 0) && (!hard || stays_inside(hard, 0)) &&
                      (!soft || stays_inside(soft, static_cast<long>(folders)));
  if (!inside) throw InputError(file, "holds " + name.string() + ", which leads out of its folder");
  const auto type = archive_entry_filetype(entry);
  if (!hard && type != AE_IFREG && type != AE_IFDIR && type != AE_IFLNK)
    throw InputError(file, "holds " + name.string() + ", a pipe or a device, which no dataset has");
}

/// Where an archive is and where it is unpacked.
struct UnpackPlaces {
  const std::filesystem::path& archive;
  const std::filesystem::path& folder;
};

void unpack_entry(archive* reader, archive* writer, archive_entry* entry, const UnpackPlaces& places,
                  SizeBound& bound) {
  archive_entry_set_pathname(entry, (places.folder / archive_entry_pathname(entry)).c_str());
  if (const char* target = archive_entry_hardlink(entry))
    archive_entry_set_hardlink(entry, (places.folder / target).c_str());
  if (archive_write_header(writer, entry) < ARCHIVE_WARN)
    throw InputError(places.archive, "cannot be unpacked: " + problem_of(writer));
  copy_data(reader, writer, places.archive, bound);
  if (archive_write_finish_entry(writer) < ARCHIVE_WARN)
    throw InputError(places.archive, "cannot be unpacked: " + problem_of(writer));
}

}  // namespace

bool unpack(const std::filesystem::path& archive_file, const std::filesystem::path& into,
            const TransferProgress& progress, std::optional<uint64_t> most_bytes) {
  std::error_code error;
  std::filesystem::create_directories(into, error);
  // Only the archive's own names are suspect: the folder may well lie behind ".." or a link.
  const std::filesystem::path folder = error ? into : std::filesystem::canonical(into, error);
  if (error) throw InputError(into, "cannot be created: " + error.message());
  const std::unique_ptr<archive, FreeReader> reader(archive_read_new());
  archive_read_support_format_all(reader.get());
  archive_read_support_filter_all(reader.get());
  if (archive_read_open_filename(reader.get(), archive_file.c_str(), kBlock) != ARCHIVE_OK) {
    throw InputError(archive_file, "is no archive that can be read: " + problem_of(reader.get()));
  }
  const std::unique_ptr<archive, FreeWriter> writer(archive_write_disk_new());
  archive_write_disk_set_options(
      writer.get(), ARCHIVE_EXTRACT_TIME | ARCHIVE_EXTRACT_SECURE_NODOTDOT | ARCHIVE_EXTRACT_SECURE_SYMLINKS);
  SizeBound bound(archive_file, most_bytes.value_or(usual_bound(archive_file, folder)));
  const uint64_t total = std::filesystem::file_size(archive_file);
  archive_entry* entry = nullptr;
  while (true) {
    const int next = archive_read_next_header(reader.get(), &entry);
    if (next == ARCHIVE_EOF) return true;
    if (next < ARCHIVE_WARN) throw damaged(archive_file, reader.get());
    check_entry(archive_file, entry);
    bound.begin();
    if (archive_entry_size_is_set(entry) != 0) bound.reach(static_cast<uint64_t>(archive_entry_size(entry)));
    unpack_entry(reader.get(), writer.get(), entry, {archive_file, folder}, bound);
    const auto done = static_cast<uint64_t>(archive_filter_bytes(reader.get(), -1));
    if (progress && !progress(done, total)) return false;
  }
}

}  // namespace surefield
