#pragma once

#include <cstddef>
#include <filesystem>

#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// A cloud read from a file.
struct PlyCloud {
  GaussianCloud cloud;
  std::size_t dropped = 0;    ///< LeftOutGaussians::broken
  std::size_t invisible = 0;  ///< LeftOutGaussians::invisible
};

/// Reads a Gaussian cloud in the usual 3DGS layout: one element `vertex` with x y z, f_dc_0..2, optional
/// f_rest_* (0, 9, 24 or 45; channel-major in the file), opacity (logit), scale_0..2 (ln metres), rot_0..3 (w
/// x y z) and optional uncertainty (m^2), in any order and of any scalar type; other properties are ignored.
/// ASCII or binary little endian. Infinities have the meaning that keep_usable() gives them. Also reads the
/// compressed layout. Throws InputError for anything else and for truncated files.
PlyCloud read_ply(const std::filesystem::path& file);

/// Writes the standard layout (x y z nx ny nz f_dc_* f_rest_* opacity scale_* rot_*, 32-bit float, binary
/// little endian) and behind it the property uncertainty. The file appears complete or not at all. Throws
/// InputError when it cannot be written.
void write_ply(const std::filesystem::path& file, const GaussianCloud& cloud);

/// Writes the compressed layout of PlayCanvas (docs/formats.md): 16 bytes a Gaussian, and one for each SH
/// coefficient above degree 0. Gaussians are sorted along a Morton curve, and every 256 share bounds between
/// which positions and ln(scale) are rounded to 11, 10 and 11 bits, colours to 8. Opacity is rounded by
/// 1/510, rotations by a tenth of a degree, SH by 1/64 (within -4 to 4). Gaussians that are not finite are
/// left out. The file appears complete or not at all. Throws InputError when it cannot be written.
void write_compressed_ply(const std::filesystem::path& file, const GaussianCloud& cloud);

/// Writes the centres as a plain point cloud for programs that know no Gaussians: x y z, red green blue (0 to
/// 255, of SH degree 0) and opacity (0 to 1), binary little endian. Gaussians that are not finite are left
/// out. The file appears complete or not at all. Throws InputError when it cannot be written.
void write_point_cloud(const std::filesystem::path& file, const GaussianCloud& cloud);

}  // namespace surefield
