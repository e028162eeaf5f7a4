#include "engine/logs/whole_pages.h"

#include <sqlite3.h>

#include <cstdint>

#include "engine/logs/byte_file.h"

namespace surefield {

namespace {

constexpr const char* kName = "surefield-whole-pages";
constexpr uint64_t kPageSizeAt =
    16;  // in the header of a database, two bytes, big endian; 1 stands for 65536

sqlite3_vfs* base_vfs() {
  static sqlite3_vfs* const base = sqlite3_vfs_find(nullptr);
  return base;
}

/// The number of bytes of a page by those two of the header; 0 where it is none that there can be.
int64_t page_size_of(const unsigned char* header) {
  const int64_t size = 256 * header[0] + header[1];
  if (size == 1) return 65536;
  return size >= 512 && (size & (size - 1)) == 0 ? size : 0;
}

/// An open file: SQLite's own, and behind it the methods that it came with.
struct OpenFile {
  sqlite3_file* file;

  const sqlite3_io_methods*& base() const {
    return *reinterpret_cast<const sqlite3_io_methods**>(reinterpret_cast<char*>(file) +
                                                         base_vfs()->szOsFile);
  }
};

int whole_pages_size(sqlite3_file* file, sqlite3_int64* size) {
  const sqlite3_io_methods* base = OpenFile{file}.base();
  const int result = base->xFileSize(file, size);
  if (result != SQLITE_OK || *size < 512) return result;
  unsigned char header[2] = {0, 0};
  if (base->xRead(file, header, 2, kPageSizeAt) != SQLITE_OK) return result;
  const int64_t page = page_size_of(header);
  if (page > 0) *size -= *size % page;
  return result;
}

int open_whole_pages(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* got) {
  const int result = base_vfs()->xOpen(base_vfs(), name, file, flags, got);
  if (!file->pMethods || (flags & SQLITE_OPEN_MAIN_DB) == 0) return result;
  auto* methods = static_cast<sqlite3_io_methods*>(sqlite3_malloc(sizeof(sqlite3_io_methods)));
  if (!methods) return SQLITE_NOMEM;
  *methods = *file->pMethods;
  OpenFile{file}.base() = file->pMethods;
  methods->xFileSize = whole_pages_size;
  methods->xClose = [](sqlite3_file* closed) {
    const sqlite3_io_methods* own = closed->pMethods;
    const sqlite3_io_methods* base = OpenFile{closed}.base();
    closed->pMethods = base;
    const int closing = base->xClose(closed);
    sqlite3_free(const_cast<sqlite3_io_methods*>(own));
    return closing;
  };
  file->pMethods = methods;
  return result;
}

/// Registers it once in a program.
const char* registered_vfs() {
  static sqlite3_vfs vfs = [] {
    sqlite3_vfs copy = *base_vfs();
    copy.zName = kName;
    copy.pNext = nullptr;
    copy.szOsFile += static_cast<int>(sizeof(const sqlite3_io_methods*));
    copy.xOpen = open_whole_pages;
    return copy;
  }();
  static const int result = sqlite3_vfs_register(&vfs, 0);
  return result == SQLITE_OK ? kName : nullptr;
}

}  // namespace

const char* whole_pages_vfs(const std::filesystem::path& file) {
  const ByteFile bytes(file);
  if (bytes.size() < 512) return nullptr;
  const std::string header = bytes.read(kPageSizeAt, 2);
  const int64_t page = page_size_of(reinterpret_cast<const unsigned char*>(header.data()));
  if (page == 0 || bytes.size() % static_cast<uint64_t>(page) == 0) return nullptr;
  sqlite3_initialize();
  return registered_vfs();
}

}  // namespace surefield
