#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

namespace surefield {

/// The axes in which a mesh file has its positions. Upright ones are a turn about the origin of the world
/// after which the z axis of the world, where the first camera of a run looks, points forward as far as it is
/// level.
enum class MeshAxes {
  World,  ///< those of the poses
  YUp,    ///< right, up, back
  ZUp     ///< right, forward, up
};

/// The upright axes that programs expect in files of that ending: z up in PLY and STL, y up in OBJ and glTF.
MeshAxes usual_axes(const std::filesystem::path& file);

/// The rotation from the world of a mesh into upright axes; `up` is up in that world, of unit length.
Eigen::Matrix3d upright_turn(const Eigen::Vector3d& up, MeshAxes axes);

/// How a file was turned.
struct MeshTurn {
  MeshAxes axes = MeshAxes::World;
  Eigen::Matrix3d world_to_file = Eigen::Matrix3d::Identity();

  /// Where up is in the world; not for MeshAxes::World.
  Eigen::Vector3d up() const { return world_to_file.row(axes == MeshAxes::YUp ? 1 : 2); }
};

/// What such a comment means, for people who open the file.
inline constexpr const char* kTurnNote =
    "turned upright: world_to_file names the axis that is up and the rotation, row by row, from the world of "
    "the "
    "poses";

/// What a comment in a file says of its turn: "world_to_file y" or z, which is up, and the rotation row by
/// row.
std::string turn_comment(const MeshTurn& turn);

/// Reads such a comment of a file; nullopt where it says something else. Throws InputError where what it says
/// is no rotation.
std::optional<MeshTurn> read_turn_comment(const std::filesystem::path& file, const std::string& comment);

}  // namespace surefield
