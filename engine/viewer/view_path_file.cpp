#include <cmath>

#include "engine/io/camera_json.h"
#include "engine/io/json_file.h"
#include "engine/types/error.h"
#include "engine/viewer/view_path.h"

namespace surefield {

namespace {

Pose read_key_pose(const JsonObject& key) {
  if (key.has("world_to_camera")) return read_rigid(key, "world_to_camera").inverse();
  if (!key.has("position")) key.fail("position", "and \"look_at\" are missing, or \"world_to_camera\"");
  const Eigen::Vector3d from = key.point("position"), at = key.point("look_at");
  if (from == at) key.fail("look_at", "must be another point than \"position\"");
  const Eigen::Vector3d up = key.has("up") ? key.point("up") : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  if (up.norm() < 1e-9) key.fail("up", "must not be zero");
  return look_at(from, at, up);
}

}  // namespace

RecordedViewPath read_view_path(const std::filesystem::path& file) {
  const JsonObject object(file);
  const Intrinsics intrinsics = read_intrinsics(object, "width", "height");
  Trajectory keys;
  for (const JsonObject& key : object.objects("keys")) {
    const double time = key.number("time");
    if (!keys.empty() && time <= keys.back().timestamp)
      key.fail("time", "must be later than that of the key before");
    keys.push_back({time, read_key_pose(key)});
  }
  if (keys.size() < 2) object.fail("keys", "must hold two keys at least");
  return {intrinsics, ViewPath(std::move(keys))};
}

}  // namespace surefield
