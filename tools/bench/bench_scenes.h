#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/gpu/device.h"
#include "engine/types/camera.h"
#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// What `surefield bench` renders.
struct BenchScene {
  std::string name;
  GaussianCloud cloud;
  Camera camera;
  std::vector<uint8_t> sensor_colour;  ///< what a sensor would see there, RGB, row-major; empty: as rendered
  std::vector<float> sensor_depth;     ///< metres, likewise
};

/// The built-in scenes, from small to large.
std::vector<std::string> bench_scene_names();

/// The built-in scene of that name: the Gaussians lie on the surfaces of the synthetic office, as a SLAM map
/// of some views around the camera's would have them: about as large as they are apart, flat, mostly opaque.
/// The same on every run. Throws InputError for an unknown name.
BenchScene make_bench_scene(gpu::Device& device, std::string_view name);

/// A scene from files: the map (read_map) and a camera, a JSON object with width, height, fx, fy, cx, cy and
/// world_to_camera (16 numbers, row by row). Throws InputError.
BenchScene load_bench_scene(const std::string& map_file, const std::string& camera_file);

}  // namespace surefield
