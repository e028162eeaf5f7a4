#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace surefield {

/// A triangle mesh with a colour per vertex. World frame, metres. Triangles are counter-clockwise seen from
/// outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> colours;  ///< RGB, 0 to 1, one per vertex; empty where the mesh has none
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// Reads a PLY mesh: element `vertex` with x y z and optional red green blue (0 to 255), element `face` with
/// a list `vertex_indices` or `vertex_index`; polygons are cut into fans of triangles, other properties are
/// ignored. ASCII or binary little endian. Throws InputError for anything else, for truncated files, for
/// indices out of range and for positions that are not finite.
TriangleMesh read_mesh(const std::filesystem::path& file);

/// Writes a PLY mesh (binary little endian; float x y z, uchar red green blue where there are colours). The
/// file appears complete or not at all. Throws InputError when it cannot be written.
void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace surefield
