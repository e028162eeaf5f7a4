#pragma once

#include <filesystem>
#include <ostream>

#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// Reads a Gaussian cloud in the SPZ format, version 2 or 3 (docs/formats.md). The flag that asks for
/// antialiasing and extensions behind the data are ignored. Throws InputError for anything else and for
/// damaged files.
GaussianCloud read_spz(const std::filesystem::path& file);

/// Writes the SPZ format, version 2: about 10 to 15 bytes a Gaussian of SH degree 0. What is read back
/// differs by rounding: positions by 1/8192 m (more where the map is larger than 2 km), ln(scale) by 1/32
/// (within -10 to 5.9), opacity by 1/510, colour by 0.0037 (within -0.44 to 1.44), SH of degree 1 by 1/32 and
/// above by 1/16 (within -1 to 1), rotations by about a degree, up to turns about an axis by 180 degrees,
/// which leave a Gaussian as it is. The file appears complete or not at all. Throws InputError when it cannot
/// be written.
void write_spz(const std::filesystem::path& file, const GaussianCloud& cloud);

/// The same to a stream; errors name `file`.
void write_spz(std::ostream& stream, const std::filesystem::path& file, const GaussianCloud& cloud);

}  // namespace surefield
