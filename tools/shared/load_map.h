#pragma once

#include <filesystem>

#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// The Gaussians of a file, with a warning on stderr where some are left out, how many and why. Throws
/// InputError.
GaussianCloud load_map(const std::filesystem::path& file);

}  // namespace surefield
