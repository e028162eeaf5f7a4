#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>

#include "engine/formats/triangle_mesh.h"
#include "engine/mesh/cell_triangles.h"

namespace surefield {

/// A corner of a cell: a point at which the distance field is known.
struct CellCorner {
  float distance = 0;  ///< to the surface, negative inside
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
};

/// Builds the surface at distance 0, cell by cell. Neighbouring cells share their vertices.
class SurfaceBuilder {
 public:
  /// Cells have sides of `cell_size` metres; that with the position 0 0 0 has its lowest corner at the
  /// origin.
  explicit SurfaceBuilder(double cell_size) : cell_size_(cell_size) {}

  /// Adds the triangles of the cell at `position`, whose coordinates lie within 2^19 of the origin.
  void add_cell(const Eigen::Vector3i& position, const std::array<CellCorner, kCellCorners>& corners);

  /// What was added so far. Call once.
  TriangleMesh take() { return std::move(mesh_); }

 private:
  uint32_t vertex_on(const CellEdge& edge, const Eigen::Vector3i& position,
                     const std::array<CellCorner, kCellCorners>& corners);

  double cell_size_;
  TriangleMesh mesh_;
  std::unordered_map<uint64_t, uint32_t> vertex_of_edge_;
};

}  // namespace surefield
