#include "engine/formats/mesh_axes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <sstream>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kTurnKey = "world_to_file";
constexpr double kTurnTolerance = 1e-5;
constexpr double kLeastForward = 1e-3;  // of a level direction, whose length is the sine of its angle with up

}  // namespace

MeshAxes usual_axes(const std::filesystem::path& file) {
  return file.extension() == ".obj" || file.extension() == ".glb" ? MeshAxes::YUp : MeshAxes::ZUp;
}

Eigen::Matrix3d upright_turn(const Eigen::Vector3d& up, MeshAxes axes) {
  const auto level = [&](const Eigen::Vector3d& direction) -> Eigen::Vector3d {
    return direction - direction.dot(up) * up;
  };
  Eigen::Vector3d forward = level(Eigen::Vector3d::UnitZ());
  // A camera that looks straight down has above it what lies before it.
  if (forward.norm() < kLeastForward) forward = level(-Eigen::Vector3d::UnitY());
  forward.normalize();
  const Eigen::Vector3d right = forward.cross(up);
  Eigen::Matrix3d turn;
  if (axes == MeshAxes::YUp)
    turn << right.transpose(), up.transpose(), -forward.transpose();
  else
    turn << right.transpose(), forward.transpose(), up.transpose();
  return turn;
}

std::string turn_comment(const MeshTurn& turn) {
  std::string text = fmt::format("{} {}", kTurnKey, turn.axes == MeshAxes::YUp ? "y" : "z");
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) text += fmt::format(" {}", turn.world_to_file(row, column));
  return text;
}

std::optional<MeshTurn> read_turn_comment(const std::filesystem::path& file, const std::string& comment) {
  std::istringstream words(comment);
  std::string key, up;
  if (!(words >> key) || key != kTurnKey) return std::nullopt;
  MeshTurn turn;
  words >> up;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) words >> turn.world_to_file(row, column);
  const Eigen::Matrix3d& r = turn.world_to_file;
  if (!words || (up != "y" && up != "z") || !(r * r.transpose()).isIdentity(kTurnTolerance) ||
      r.determinant() < 0)
    throw InputError(file,
                     fmt::format("its comment {} is no y or z and the nine numbers of a rotation; remove the "
                                 "line where the mesh is in the world of its run",
                                 kTurnKey));
  turn.axes = up == "y" ? MeshAxes::YUp : MeshAxes::ZUp;
  return turn;
}

}  // namespace surefield
