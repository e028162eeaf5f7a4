#include "engine/formats/map_file.h"

#include <fmt/format.h>

#include <fstream>

#include "engine/formats/foreign_map.h"
#include "engine/formats/glb.h"
#include "engine/formats/gzip.h"
#include "engine/formats/ply.h"
#include "engine/formats/spz.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// The first bytes of the file. Throws InputError where there is none that can be read: opening anything but
/// a file could wait for ever.
std::string start_of(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    throw InputError(file, "is a folder; give the file of a map, as its map.ply");
  if (!std::filesystem::exists(file)) throw InputError(file, "no such file; check the path");
  if (!std::filesystem::is_regular_file(file)) throw InputError(file, "is no file that can be read as a map");
  std::string start(4, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  return start;
}

/// Whether the file is to be read as SPZ: by its first bytes, or by its name, so that a damaged file is
/// refused as what it is meant to be.
bool is_spz(const std::filesystem::path& file) {
  const std::string start = start_of(file);
  if (starts_as_gzip(start) || start == "NGSP") return true;
  if (const std::string foreign = foreign_map_format(file); !foreign.empty()) throw InputError(file, foreign);
  return file.extension() == ".spz";
}

// Of the pixel^2 that a Gaussian was seen with, what a file without GaussianCloud::sampling adds to its
// variances: less than our own renders add, since its readers add 0.3 pixels^2 of theirs
// (docs/experiments.md).
constexpr float kWidening = 0.1f;

/// The Gaussians for a format that has no place for their sampling, so that there are no seams between them
/// closer up either.
GaussianCloud widened(GaussianCloud cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float more = kWidening * cloud.sampling[i] * cloud.sampling[i];
    if (more > 0)
      cloud.log_scales[i] = 0.5f * ((2 * cloud.log_scales[i].array()).exp() + more).log().matrix();
  }
  return cloud;
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

std::string left_out_text(std::size_t dropped, std::size_t invisible) {
  std::string text;
  if (dropped > 0) text = fmt::format("{} hold NaN or infinite values or no rotation", dropped);
  if (invisible > 0) text += fmt::format("{}{} have opacity 0 (-inf)", text.empty() ? "" : ", ", invisible);
  return text;
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
  if (ply.cloud.size() == 0 && ply.dropped + ply.invisible > 0) {
    throw InputError(file,
                     fmt::format("none of its {} Gaussians can be used: {}", ply.dropped + ply.invisible,
                                 left_out_text(ply.dropped, ply.invisible)));
  }
  return {std::move(ply.cloud), ply.dropped, ply.invisible};
}

void write_map(const std::filesystem::path& file, const GaussianCloud& cloud, MapFormat format) {
  if (!cloud.is_consistent()) throw UsageError("write_map: the arrays of the cloud differ in length");
  switch (format) {
    case MapFormat::Ply:
      return write_ply(file, cloud);
    case MapFormat::CompressedPly:
      return write_compressed_ply(file, widened(cloud));
    case MapFormat::Spz:
      return write_spz(file, widened(cloud));
    case MapFormat::Glb:
      return write_glb(file, widened(cloud));
    case MapFormat::Points:
      return write_point_cloud(file, cloud);
  }
}

void write_map(const std::filesystem::path& file, const GaussianCloud& cloud) {
  write_map(file, cloud, map_format_of(file));
}

}  // namespace surefield
