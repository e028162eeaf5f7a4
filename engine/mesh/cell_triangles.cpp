// The table of marching cubes, made from the geometry of a cube. On each face, every run of corners inside is
// cut off by a segment between the two edges at which the run begins and ends. Walking around each face
// counter-clockwise seen from outside the cell, a crossed edge begins a run in one of its two faces and ends
// one in the other; so the segments chain up to closed polygons, which all turn the same way.
#include "engine/mesh/cell_triangles.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace surefield {

namespace {

/// The corners of the six faces, counter-clockwise seen from outside the cell.
constexpr std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

using Triangles = std::vector<std::array<uint8_t, 3>>;
using Polygon = std::vector<int>;  // edges of the cell

std::array<CellEdge, 12> make_edges() {
  std::array<CellEdge, 12> edges{};
  std::size_t count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < kCellCorners; ++corner) {
      if (!(corner >> axis & 1)) edges[count++] = {corner, corner | 1 << axis, axis};
    }
  }
  return edges;
}

int edge_between(int a, int b) {
  const auto& edges = cell_edges();
  const auto joins = [&](const CellEdge& e) { return e.from == std::min(a, b) && e.to == std::max(a, b); };
  return static_cast<int>(std::find_if(edges.begin(), edges.end(), joins) - edges.begin());
}

/// For each edge, the edge that the surface's polygon goes on to; -1 where the surface does not cross it.
std::array<int, 12> make_chain(uint8_t inside) {
  const auto is_inside = [&](int corner) { return (inside >> corner & 1) != 0; };
  std::array<int, 12> next{};
  next.fill(-1);
  for (const auto& face : kFaces) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!is_inside(face[i]) || is_inside(face[(i + 3) % 4])) continue;
      std::size_t last = i;  // of the run of corners inside that begins with i
      while (is_inside(face[(last + 1) % 4])) last = (last + 1) % 4;
      const int begin = edge_between(face[(i + 3) % 4], face[i]);
      next[static_cast<std::size_t>(begin)] = edge_between(face[last], face[(last + 1) % 4]);
    }
  }
  return next;
}

std::vector<Polygon> make_polygons(uint8_t inside) {
  std::array<int, 12> next = make_chain(inside);
  std::vector<Polygon> polygons;
  for (int first = 0; first < 12; ++first) {
    Polygon polygon;
    for (int edge = first; next[static_cast<std::size_t>(edge)] >= 0;) {
      polygon.push_back(edge);
      edge = std::exchange(next[static_cast<std::size_t>(edge)], -1);
    }
    if (!polygon.empty()) polygons.push_back(polygon);
  }
  return polygons;
}

bool share_face(int a, int b) {
  const auto on_face = [](int edge, const std::array<int, 4>& face) {
    const CellEdge& e = cell_edges()[static_cast<std::size_t>(edge)];
    return std::count(face.begin(), face.end(), e.from) + std::count(face.begin(), face.end(), e.to) == 2;
  };
  return std::any_of(kFaces.begin(), kFaces.end(),
                     [&](const auto& face) { return on_face(a, face) && on_face(b, face); });
}

/// Cuts a polygon into a fan. It begins where fewest of its diagonals lie in a face of the cell: there they
/// could coincide with those of the neighbouring cell.
void add_fan(const Polygon& polygon, Triangles& triangles) {
  const std::size_t n = polygon.size();
  const auto diagonals_in_faces = [&](std::size_t start) {
    int count = 0;
    for (std::size_t k = 2; k + 1 < n; ++k) {
      count += share_face(polygon[start], polygon[(start + k) % n]) ? 1 : 0;
    }
    return count;
  };
  std::size_t best = 0;
  for (std::size_t start = 1; start < n; ++start) {
    if (diagonals_in_faces(start) < diagonals_in_faces(best)) best = start;
  }
  const auto at = [&](std::size_t k) { return static_cast<uint8_t>(polygon[(best + k) % n]); };
  for (std::size_t k = 1; k + 1 < n; ++k) triangles.push_back({at(0), at(k), at(k + 1)});
}

std::array<Triangles, 256> make_table() {
  std::array<Triangles, 256> table;
  for (std::size_t inside = 0; inside < table.size(); ++inside) {
    for (const Polygon& polygon : make_polygons(static_cast<uint8_t>(inside))) {
      add_fan(polygon, table[inside]);
    }
  }
  return table;
}

}  // namespace

const std::array<CellEdge, 12>& cell_edges() {
  static const std::array<CellEdge, 12> edges = make_edges();
  return edges;
}

const std::vector<std::array<uint8_t, 3>>& cell_triangles(uint8_t inside) {
  static const std::array<Triangles, 256> table = make_table();
  return table[inside];
}

}  // namespace surefield
