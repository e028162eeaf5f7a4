#pragma once

#include <cstddef>
#include <filesystem>

#include "engine/splat/gaussian_cloud.h"

namespace surefield {

/// A cloud read from a file.
struct PlyCloud {
  GaussianCloud cloud;
  std::size_t dropped = 0;  ///< Gaussians left out because a value was NaN or infinite or the rotation zero
};

/// Reads a Gaussian cloud in the usual 3DGS layout: one element `vertex` with x y z, f_dc_0..2, optional
/// f_rest_* (0, 9, 24 or 45; channel-major in the file), opacity (logit), scale_0..2 (ln metres), rot_0..3 (w
/// x y z) and optional uncertainty (m^2), in any order and of any scalar type; other properties are ignored.
/// ASCII or binary little endian. Throws InputError for anything else and for truncated files.
PlyCloud read_ply(const std::filesystem::path& file);

/// Writes the standard layout (x y z nx ny nz f_dc_* f_rest_* opacity scale_* rot_*, 32-bit float, binary
/// little endian) and behind it the property uncertainty. The file appears complete or not at all. Throws
/// InputError when it cannot be written.
void write_ply(const std::filesystem::path& file, const GaussianCloud& cloud);

}  // namespace surefield
