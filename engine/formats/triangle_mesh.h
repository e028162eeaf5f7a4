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

/// The normal of each vertex, of unit length: that of its triangles, weighed by their areas; zero where it
/// has none. World frame, outwards.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh);

/// Throws UsageError where the mesh has colours, but not one per vertex, or more vertices than a PLY file can
/// tell apart.
void check_mesh(const TriangleMesh& mesh);

/// Writes a PLY mesh (binary little endian; float x y z nx ny nz, uchar red green blue where there are
/// colours). The file appears complete or not at all. Throws InputError when it cannot be written.
void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace surefield
