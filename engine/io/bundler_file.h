#pragma once

#include <filesystem>

#include "engine/types/trajectory.h"

namespace surefield {

/// The cameras of Bundler's bundle.out, in its order, numbered from 0. It has them as rotation and
/// translation from world to camera, y up and looking along -z. Cameras that were not registered (all zeros)
/// are not finite. Throws InputError.
Trajectory read_bundler(const std::filesystem::path& file);

}  // namespace surefield
