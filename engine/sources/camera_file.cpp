#include "engine/sources/camera_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/config/config.h"
#include "engine/io/images.h"
#include "engine/io/json_file.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kLargestPixel = 1e6;
constexpr double kSmallestUnit = 1e-9;  // metres
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

struct KnownCamera {
  const char* name;
  RecordedCamera camera;
};

const std::vector<KnownCamera>& known_cameras() {
  using enum LensDistortion::Model;
  static const std::vector<KnownCamera> cameras = {
      {"freiburg1",
       {{640, 480, 517.3, 516.5, 318.6, 255.3},
        {RadialTangential, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}},
        kTumDepthUnit}},
      {"freiburg2",
       {{640, 480, 520.9, 521.0, 325.1, 249.7},
        {RadialTangential, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}},
        kTumDepthUnit}},
      {"freiburg3", {{640, 480, 535.4, 539.2, 320.1, 247.6}, {}, kTumDepthUnit}},
      {"bonn",
       {{640, 480, 542.822841, 542.576870, 315.593520, 237.756098},
        {RadialTangential, {0.039903, -0.099343, -0.000730, -0.000144, 0}},
        kTumDepthUnit}},
      {"icl", {{640, 480, 481.2, 480.0, 319.5, 239.5}, {}, kTumDepthUnit}},
  };
  return cameras;
}

/// The number of coefficients that OpenCV has a model for, so that no list of another length is taken for
/// one.
void check_distortion(const std::filesystem::path& file, const LensDistortion& distortion) {
  const std::size_t count = distortion.coefficients.size();
  if (distortion.model == LensDistortion::Model::Fisheye && count != 4 && count != 0) {
    throw InputError(file,
                     fmt::format("distortion has {} numbers, a fisheye lens has 4: k1 k2 k3 k4", count));
  }
}

}  // namespace

RecordedCamera read_camera_file(const std::filesystem::path& file) {
  RecordedCamera camera;
  Intrinsics& k = camera.intrinsics;
  k.fx = k.fy = k.cx = k.cy = camera.depth_unit = kMissing;
  ConfigSchema schema;
  schema.add("width", &k.width, Range{1, kLargestSide});
  schema.add("height", &k.height, Range{1, kLargestSide});
  schema.add("fx", &k.fx, Range{1e-3, kLargestPixel});
  schema.add("fy", &k.fy, Range{1e-3, kLargestPixel});
  schema.add("cx", &k.cx, Range{-kLargestPixel, kLargestPixel});
  schema.add("cy", &k.cy, Range{-kLargestPixel, kLargestPixel});
  schema.add("distortion", &camera.distortion.coefficients, Range{-1e3, 1e3}, {0, 4, 5, 8, 12, 14});
  schema.add("distortion_model", &camera.distortion.model,
             Choices<LensDistortion::Model>{{"radtan", LensDistortion::Model::RadialTangential},
                                            {"fisheye", LensDistortion::Model::Fisheye}});
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
  check_distortion(file, camera.distortion);
  std::vector<double>& coefficients = camera.distortion.coefficients;
  if (std::all_of(coefficients.begin(), coefficients.end(), [](double value) { return value == 0; }) &&
      camera.distortion.model == LensDistortion::Model::RadialTangential)
    coefficients.clear();
  return camera;
}

RecordedCamera read_open3d_camera(const std::filesystem::path& file) {
  const JsonObject json(file);
  const char* const kMatrix = "intrinsic_matrix";
  const nlohmann::json& matrix = json.at(kMatrix);
  const auto is_number = [](const nlohmann::json& value) { return value.is_number(); };
  if (!matrix.is_array() || matrix.size() != 9 || !std::all_of(matrix.begin(), matrix.end(), is_number))
    json.fail(kMatrix, "is no list of nine numbers");
  const auto m = matrix.get<std::vector<double>>();
  if (!(m[0] > 0) || !(m[4] > 0) || m[2] != 0 || m[5] != 0 || m[8] != 1)
    json.fail(kMatrix, "is no camera matrix, column after column: fx 0 0 0 fy 0 cx cy 1");
  RecordedCamera camera;
  camera.intrinsics = {static_cast<int>(json.positive("width")),
                       static_cast<int>(json.positive("height")),
                       m[0],
                       m[4],
                       m[6],
                       m[7]};
  camera.depth_unit = json.has("depth_scale") ? 1 / json.positive("depth_scale") : kMillimetre;
  return camera;
}

RecordedCamera read_eth3d_camera(const std::filesystem::path& file) {
  const auto numbers = read_numbers(file);
  if (!numbers || numbers->size() != 4 || !((*numbers)[0] > 0) || !((*numbers)[1] > 0))
    throw InputError(file, "expected \"fx fy cx cy\", pixels");
  RecordedCamera camera;
  camera.intrinsics = {0, 0, (*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  camera.depth_unit = kTumDepthUnit;
  return camera;
}

RecordedCamera known_camera(const std::string& name) {
  for (const KnownCamera& known : known_cameras())
    if (name == known.name) return known.camera;
  throw InputError(fmt::format("there is no known camera \"{}\"; there are {}", name,
                               fmt::join(known_camera_names(), ", ")));
}

std::vector<std::string> known_camera_names() {
  std::vector<std::string> names;
  for (const KnownCamera& known : known_cameras()) names.emplace_back(known.name);
  return names;
}

}  // namespace surefield
