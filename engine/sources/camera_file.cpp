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

/// The keys of one camera: those of the file itself, or of a section of it.
struct CameraKeys {
  const std::filesystem::path& file;
  std::string section;  ///< with its dot
  Intrinsics& camera;
  LensDistortion& distortion;

  void bind(ConfigSchema& schema) {
    camera.fx = camera.fy = camera.cx = camera.cy = kMissing;
    schema.add(section + "width", &camera.width, Range{1, kLargestSide});
    schema.add(section + "height", &camera.height, Range{1, kLargestSide});
    schema.add(section + "fx", &camera.fx, Range{1e-3, kLargestPixel});
    schema.add(section + "fy", &camera.fy, Range{1e-3, kLargestPixel});
    schema.add(section + "cx", &camera.cx, Range{-kLargestPixel, kLargestPixel});
    schema.add(section + "cy", &camera.cy, Range{-kLargestPixel, kLargestPixel});
    schema.add(section + "distortion", &distortion.coefficients, Range{-1e3, 1e3}, {0, 4, 5, 8, 12, 14});
    schema.add(section + "distortion_model", &distortion.model,
               Choices<LensDistortion::Model>{{"radtan", LensDistortion::Model::RadialTangential},
                                              {"fisheye", LensDistortion::Model::Fisheye}});
  }

  void require(const char* key, double value) const {
    if (std::isnan(value)) throw InputError(file, section + key + " is missing");
  }

  /// After the file has been read.
  void check() {
    require("fx", camera.fx);
    require("fy", camera.fy);
    require("cx", camera.cx);
    require("cy", camera.cy);
    if ((camera.width == 0) != (camera.height == 0))
      throw InputError(file, section + "width and height are given both or not at all");
    std::vector<double>& numbers = distortion.coefficients;
    const bool fisheye = distortion.model == LensDistortion::Model::Fisheye;
    if (fisheye && numbers.size() != 4 && !numbers.empty()) {
      throw InputError(file, fmt::format("{}distortion has {} numbers, a fisheye lens has 4: k1 k2 k3 k4",
                                         section, numbers.size()));
    }
    const bool straight = std::all_of(numbers.begin(), numbers.end(), [](double k) { return k == 0; });
    if (straight && !fisheye) numbers.clear();
  }
};

/// Whether the file says anything of a depth camera.
bool says_anything(const RecordedDepthCamera& camera, const std::vector<double>& depth_to_colour) {
  const Intrinsics& k = camera.intrinsics;
  return k.width != 0 || k.height != 0 || !std::isnan(k.fx) || !std::isnan(k.fy) || !std::isnan(k.cx) ||
         !std::isnan(k.cy) || !camera.distortion.empty() || !depth_to_colour.empty();
}

}  // namespace

RecordedCamera read_camera_file(const std::filesystem::path& file) {
  RecordedCamera camera;
  camera.depth_unit = kMissing;
  RecordedDepthCamera depth;
  std::vector<double> depth_to_colour;
  CameraKeys keys{file, "", camera.intrinsics, camera.distortion};
  CameraKeys depth_keys{file, "depth.", depth.intrinsics, depth.distortion};
  ConfigSchema schema;
  keys.bind(schema);
  schema.add("depth_unit", &camera.depth_unit, Range{kSmallestUnit, 1e3});
  depth_keys.bind(schema);
  schema.add("depth.depth_to_colour", &depth_to_colour, Range{-1e3, 1e3}, {0, 16});
  schema.load_file(file);
  keys.check();
  keys.require("depth_unit", camera.depth_unit);
  if (!says_anything(depth, depth_to_colour)) return camera;
  depth_keys.check();
  if (depth.intrinsics.width == 0) throw InputError(file, "depth.width and depth.height are missing");
  if (camera.intrinsics.width == 0)
    throw InputError(file, "width and height are missing; where there is a section depth they are needed");
  const auto transform = rigid_from_rows(depth_to_colour);
  if (!transform)
    throw InputError(file, "depth.depth_to_colour must be a rigid 4 x 4 matrix by rows, 16 numbers");
  depth.depth_to_colour = *transform;
  camera.depth_camera = depth;
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
