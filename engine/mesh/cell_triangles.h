#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace surefield {

/// Corner i of a cell lies at (i & 1, i >> 1 & 1, i >> 2 & 1) from its lowest corner.
constexpr int kCellCorners = 8;

/// An edge of a cell: its two ends; the first one is the lower.
struct CellEdge {
  int from = 0;
  int to = 0;
  int axis = 0;  ///< the one along which it runs
};

/// The twelve edges of a cell.
const std::array<CellEdge, 12>& cell_edges();

/// The surface through a cell (marching cubes): triangles between points on its edges, which are numbered as
/// in cell_edges(). Bit i of `inside` says that corner i lies inside, which is behind the surface. Triangles
/// are counter-clockwise seen from outside. Where a face of the cell can be cut in two ways, corners inside
/// are kept apart, in every cell, so that the triangles of neighbouring cells fit.
const std::vector<std::array<uint8_t, 3>>& cell_triangles(uint8_t inside);

}  // namespace surefield
