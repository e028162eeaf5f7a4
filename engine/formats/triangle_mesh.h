#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/formats/mesh_axes.h"

namespace surefield {

/// A triangle mesh with a colour per vertex. World frame, metres. Triangles are counter-clockwise seen from
/// outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> colours;  ///< RGB, 0 to 1, one per vertex; empty where the mesh has none
  std::vector<std::array<uint32_t, 3>> triangles;
  std::optional<Eigen::Vector3d> up;  ///< where up is in that frame, unit length; nullopt: not known
};

/// Reads a PLY mesh: element `vertex` with x y z and optional red green blue (0 to 255), element `face` with
/// a list `vertex_indices` or `vertex_index`; polygons are cut into fans of triangles, other properties are
/// ignored. ASCII or binary little endian. Where a comment tells how the file was turned upright
/// (mesh_axes.h), the mesh is turned back, and its `up` is known. Throws InputError for anything else, for
/// truncated files, for indices out of range and for positions that are not finite.
TriangleMesh read_mesh(const std::filesystem::path& file);

/// The normal of each vertex, of unit length: that of its triangles, weighed by their areas; zero where it
/// has none. World frame, outwards.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh);

/// Throws UsageError where the mesh has colours, but not one per vertex, or more vertices than a PLY file can
/// tell apart.
void check_mesh(const TriangleMesh& mesh);

/// The turn of a file with these axes. Throws UsageError where they are upright, but the mesh does not know
/// where up is.
MeshTurn turn_of(const TriangleMesh& mesh, MeshAxes axes);

/// The mesh with its positions as they are in a file.
TriangleMesh turned(const TriangleMesh& mesh, const MeshTurn& turn);

/// Writes a PLY mesh (binary little endian; float x y z nx ny nz, uchar red green blue where there are
/// colours), turned to `axes`, of which a comment tells. The file appears complete or not at all. Throws
/// InputError when it cannot be written.
void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh, MeshAxes axes = MeshAxes::World);

}  // namespace surefield
