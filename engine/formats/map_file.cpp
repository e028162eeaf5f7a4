#include "engine/formats/map_file.h"

#include <fstream>

#include "engine/formats/glb.h"
#include "engine/formats/gzip.h"
#include "engine/formats/ply.h"
#include "engine/formats/spz.h"
#include "engine/types/error.h"

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

const std::map<std::string, MapFormat>& map_formats() {
  static const std::map<std::string, MapFormat> formats = {{"ply", MapFormat::Ply},
                                                           {"cply", MapFormat::CompressedPly},
                                                           {"spz", MapFormat::Spz},
                                                           {"glb", MapFormat::Glb},
                                                           {"points", MapFormat::Points}};
  return formats;
}

std::vector<std::string> run_map_formats() {
  return {"ply", "spz"};
}

MapFormat map_format_of(const std::filesystem::path& file) {
  if (file.filename().string().ends_with(".compressed.ply")) return MapFormat::CompressedPly;
  if (file.extension() == ".ply") return MapFormat::Ply;
  if (file.extension() == ".spz") return MapFormat::Spz;
  if (file.extension() == ".glb") return MapFormat::Glb;
  throw InputError(file, "has no ending of a map format; name it .ply, .compressed.ply, .spz or .glb");
}

MapFile read_map(const std::filesystem::path& file) {
  if (is_spz(file)) return {.cloud = read_spz(file)};
  PlyCloud ply = read_ply(file);
  return {std::move(ply.cloud), ply.dropped};
}

void write_map(const std::filesystem::path& file, const GaussianCloud& cloud, MapFormat format) {
  switch (format) {
    case MapFormat::Ply:
      return write_ply(file, cloud);
    case MapFormat::CompressedPly:
      return write_compressed_ply(file, cloud);
    case MapFormat::Spz:
      return write_spz(file, cloud);
    case MapFormat::Glb:
      return write_glb(file, cloud);
    case MapFormat::Points:
      return write_point_cloud(file, cloud);
  }
}

void write_map(const std::filesystem::path& file, const GaussianCloud& cloud) {
  write_map(file, cloud, map_format_of(file));
}

}  // namespace surefield
