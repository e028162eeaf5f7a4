#include "engine/sources/camera_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/config/config.h"
#include "engine/io/images.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kLargestPixel = 1e6;
constexpr double kSmallestUnit = 1e-9;  // metres
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

RecordedCamera read_camera_file(const std::filesystem::path& file) {
  RecordedCamera camera;
  Intrinsics& k = camera.intrinsics;
  k.fx = k.fy = k.cx = k.cy = camera.depth_unit = kMissing;
  camera.distortion.assign(5, 0.0);
  ConfigSchema schema;
  schema.add("width", &k.width, Range{1, kLargestSide});
  schema.add("height", &k.height, Range{1, kLargestSide});
  schema.add("fx", &k.fx, Range{1e-3, kLargestPixel});
  schema.add("fy", &k.fy, Range{1e-3, kLargestPixel});
  schema.add("cx", &k.cx, Range{-kLargestPixel, kLargestPixel});
  schema.add("cy", &k.cy, Range{-kLargestPixel, kLargestPixel});
  schema.add("distortion", &camera.distortion, Range{-1e3, 1e3});
  schema.add("depth_unit", &camera.depth_unit, Range{kSmallestUnit, 1e3});
  schema.load_file(file);
  const auto require = [&](const char* key, double value) {
    if (std::isnan(value)) throw InputError(file, std::string(key) + " is missing");
  };
  require("fx", k.fx);
  require("fy", k.fy);
  require("cx", k.cx);
  require("cy", k.cy);
  require("depth_unit", camera.depth_unit);
  if ((k.width == 0) != (k.height == 0)) {
    throw InputError(file, "width and height are given both or not at all");
  }
  const bool plain = std::all_of(camera.distortion.begin(), camera.distortion.end(),
                                 [](double coefficient) { return coefficient == 0; });
  if (plain) camera.distortion.clear();
  return camera;
}

}  // namespace surefield
