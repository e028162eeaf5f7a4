#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/types/relative_pose.h"

namespace surefield {

/// A graph of poses as a g2o file has it, in this project's terms.
struct G2oGraph {
  struct Vertex {
    std::int64_t id = 0;  ///< in the file
    Pose pose;            ///< world to camera
    bool fixed = false;
  };
  std::vector<Vertex> vertices;     ///< in the order of the file
  std::vector<RelativePose> edges;  ///< between places in `vertices`
};

// g2o's vertex is X = T^-1, camera to world; its edge measures M = X_i^-1 X_j = Z^-1, and its error M^-1
// X_i^-1 X_j is the inverse of ours, D = T_j T_i^-1 Z^-1. Both are in the camera j, so that the information
// matrix, of translation and rotation in that order, is the same. The three numbers of the rotation are taken
// as a rotation vector in radians, as Ceres' pose_graph_3d, GTSAM and SE-Sync take them and as the noise of
// the published graphs bears out; g2o's own program weighs its error by the vector part of the quaternion,
// half of that.

/// Reads VERTEX_SE3:QUAT, EDGE_SE3:QUAT and FIX, in any order; '#' starts a comment, PARAMS_... are passed
/// over. Throws InputError naming file and line: another tag, a number too many or too few, an edge to a
/// vertex that the file has not, a vertex twice, an information matrix that no covariance has.
G2oGraph read_g2o(const std::filesystem::path& file);

/// Writes such a file with all digits: it is read back as it was, up to rounding of the last digit. Throws
/// InputError when it cannot be written.
void write_g2o(const std::filesystem::path& file, const G2oGraph& graph);

}  // namespace surefield
