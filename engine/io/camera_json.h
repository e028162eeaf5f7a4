#pragma once

#include <filesystem>
#include <string>

#include "engine/io/json_file.h"
#include "engine/types/camera.h"

namespace surefield {

/// Pinhole intrinsics from an object: the size under `width_key` and `height_key` (whole pixels), and fx, fy,
/// cx, cy. Throws InputError.
Intrinsics read_intrinsics(const JsonObject& object, const std::string& width_key,
                           const std::string& height_key);

/// The rigid transform under `key`, four rows of four numbers. Throws InputError.
Pose read_rigid(const JsonObject& object, const std::string& key);

/// Reads a camera from JSON: numbers width, height, fx, fy, cx, cy (pixels) and world_to_camera, four rows of
/// four numbers (metres). Throws InputError naming the key that is missing or wrong, also where the rotation
/// is none.
Camera read_camera(const std::filesystem::path& file);

/// Writes a camera as read_camera() reads it; no digit is lost. Throws InputError when the file cannot be
/// written.
void write_camera(const std::filesystem::path& file, const Camera& camera);

}  // namespace surefield
