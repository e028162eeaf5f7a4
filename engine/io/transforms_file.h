#pragma once

#include <filesystem>

#include "engine/types/trajectory.h"

namespace surefield {

/// The cameras of a transforms.json as nerfstudio and instant-ngp read it, in the order of the numbers in
/// their file_path where all have one, else in that of the file; numbered from 0. It has them as 4 x 4
/// matrices from camera to world, y up and looking along -z. Throws InputError.
Trajectory read_transforms(const std::filesystem::path& file);

}  // namespace surefield
