#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// How Gaussians are written (docs/formats.md). The first three are read, too.
enum class MapFormat { Ply, CompressedPly, Spz, Glb, Points };

/// All of them by the names that users give them: "ply", "cply", "spz", "glb", "points".
const std::map<std::string, MapFormat>& map_formats();

/// Those in which a run may store its map.
std::vector<std::string> run_map_formats();

/// The format that the file's ending names: .ply, .compressed.ply, .spz or .glb. Throws InputError for
/// others.
MapFormat map_format_of(const std::filesystem::path& file);

/// A map read from a file.
struct MapFile {
  GaussianCloud cloud;
  std::size_t dropped = 0;    ///< Gaussians left out because they could not be drawn (docs/formats.md)
  std::size_t invisible = 0;  ///< those whose opacity was 0, left out too
};

/// Why so many Gaussians were left out, for people; empty for none.
std::string left_out_text(std::size_t dropped, std::size_t invisible);

/// Reads Gaussians in any format that is known (docs/formats.md), told by the content. Throws InputError,
/// also where all Gaussians had to be left out, and names formats of other programs that are not read.
MapFile read_map(const std::filesystem::path& file);

/// Writes Gaussians. The file appears complete or not at all. Throws InputError when it cannot be written.
void write_map(const std::filesystem::path& file, const GaussianCloud& cloud, MapFormat format);

/// The same in the format that the file's ending names.
void write_map(const std::filesystem::path& file, const GaussianCloud& cloud);

}  // namespace surefield
