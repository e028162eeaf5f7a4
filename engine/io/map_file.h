#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/splat/gaussian_cloud.h"

namespace surefield {

/// The formats that write_map() knows, as extensions without the dot: "ply", "spz".
std::vector<std::string> map_formats();

/// A map read from a file.
struct MapFile {
  GaussianCloud cloud;
  std::size_t dropped = 0;  ///< Gaussians left out because they were not finite
};

/// Reads Gaussians in any format that is known (docs/formats.md), told by the content. Throws InputError.
MapFile read_map(const std::filesystem::path& file);

/// Writes Gaussians in the format that the extension names. The file appears complete or not at all. Throws
/// InputError for another extension and when it cannot be written.
void write_map(const std::filesystem::path& file, const GaussianCloud& cloud);

}  // namespace surefield
