#include "engine/io/camera_json.h"

#include <cmath>

#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/io/text_file.h"

namespace surefield {

namespace {

int read_side(const JsonObject& object, const std::string& key) {
  const double side = object.positive(key);
  if (side != std::floor(side) || side > kLargestSide) object.fail(key, "must be a whole number of pixels");
  return static_cast<int>(side);
}

/// The 16 numbers of a 4 x 4 matrix that is stored as an array of rows.
std::vector<double> read_rows(const JsonObject& object, const std::string& key) {
  const nlohmann::json& rows = object.at(key);
  std::vector<double> numbers;
  for (const nlohmann::json& row : rows) {
    if (!rows.is_array() || !row.is_array() || row.size() != 4)
      object.fail(key, "must be four rows of four numbers");
    for (const nlohmann::json& number : row) {
      if (!number.is_number()) object.fail(key, "must hold numbers only");
      numbers.push_back(number.get<double>());
    }
  }
  return numbers;
}

}  // namespace

Intrinsics read_intrinsics(const JsonObject& object, const std::string& width_key,
                           const std::string& height_key) {
  Intrinsics intrinsics;
  intrinsics.width = read_side(object, width_key);
  intrinsics.height = read_side(object, height_key);
  intrinsics.fx = object.positive("fx");
  intrinsics.fy = object.positive("fy");
  intrinsics.cx = object.number("cx");
  intrinsics.cy = object.number("cy");
  return intrinsics;
}

Pose read_rigid(const JsonObject& object, const std::string& key) {
  const auto pose = rigid_from_rows(read_rows(object, key));
  if (!pose || !pose->matrix().allFinite())
    object.fail(key, "must be a rotation and a translation, with the last row 0 0 0 1");
  return *pose;
}

Camera read_camera(const std::filesystem::path& file) {
  const JsonObject object(file);
  Camera camera;
  camera.intrinsics = read_intrinsics(object, "width", "height");
  camera.world_to_camera = read_rigid(object, "world_to_camera");
  return camera;
}

void write_camera(const std::filesystem::path& file, const Camera& camera) {
  const Intrinsics& k = camera.intrinsics;
  nlohmann::ordered_json json = {{"width", k.width}, {"height", k.height}, {"fx", k.fx},
                                 {"fy", k.fy},       {"cx", k.cx},         {"cy", k.cy}};
  const Eigen::Matrix4d pose = camera.world_to_camera.matrix();
  for (int r = 0; r < 4; ++r)
    json["world_to_camera"].push_back({pose(r, 0), pose(r, 1), pose(r, 2), pose(r, 3)});
  write_file(file, [&](std::ostream& stream) { stream << json.dump(1) << "\n"; });
}

}  // namespace surefield
