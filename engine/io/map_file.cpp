#include "engine/io/map_file.h"

#include <fstream>

#include "engine/io/error.h"
#include "engine/io/gzip.h"
#include "engine/io/ply.h"
#include "engine/io/spz.h"

namespace surefield {

namespace {

/// Whether the file is to be read as SPZ: by its first bytes, or by its name, so that a damaged file is
/// refused as what it is meant to be.
bool is_spz(const std::filesystem::path& file) {
  std::string start(4, '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  return starts_as_gzip(start) || start == "NGSP" || file.extension() == ".spz";
}

}  // namespace

std::vector<std::string> map_formats() {
  return {"ply", "spz"};
}

MapFile read_map(const std::filesystem::path& file) {
  if (is_spz(file)) return {.cloud = read_spz(file)};
  PlyCloud ply = read_ply(file);
  return {std::move(ply.cloud), ply.dropped};
}

void write_map(const std::filesystem::path& file, const GaussianCloud& cloud) {
  if (file.extension() == ".ply") return write_ply(file, cloud);
  if (file.extension() == ".spz") return write_spz(file, cloud);
  throw InputError(file, "has no ending of a map format; name it .ply or .spz");
}

}  // namespace surefield
