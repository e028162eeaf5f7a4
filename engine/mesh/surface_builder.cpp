#include "engine/mesh/surface_builder.h"

namespace surefield {

namespace {

Eigen::Vector3i corner_offset(int corner) {
  return {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
}

/// A number of its own for each edge of the lattice.
uint64_t edge_key(const Eigen::Vector3i& lower_end, int axis) {
  const auto bits = [](int x) { return static_cast<uint64_t>(static_cast<uint32_t>(x)) & 0xfffff; };
  return bits(lower_end.x()) << 42 | bits(lower_end.y()) << 22 | bits(lower_end.z()) << 2 |
         static_cast<uint64_t>(axis);
}

}  // namespace

void SurfaceBuilder::add_cell(const Eigen::Vector3i& position,
                              const std::array<CellCorner, kCellCorners>& corners) {
  uint8_t inside = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i].distance < 0) inside = static_cast<uint8_t>(inside | 1u << i);
  }
  for (const auto& triangle : cell_triangles(inside)) {
    std::array<uint32_t, 3> vertices{};
    for (std::size_t k = 0; k < 3; ++k) {
      vertices[k] = vertex_on(cell_edges()[triangle[k]], position, corners);
    }
    mesh_.triangles.push_back(vertices);
  }
}

uint32_t SurfaceBuilder::vertex_on(const CellEdge& edge, const Eigen::Vector3i& position,
                                   const std::array<CellCorner, kCellCorners>& corners) {
  const Eigen::Vector3i lower_end = position + corner_offset(edge.from);
  const auto next = static_cast<uint32_t>(mesh_.vertices.size());
  const auto [entry, is_new] = vertex_of_edge_.try_emplace(edge_key(lower_end, edge.axis), next);
  if (!is_new) return entry->second;
  const CellCorner& from = corners[static_cast<std::size_t>(edge.from)];
  const CellCorner& to = corners[static_cast<std::size_t>(edge.to)];
  // One distance is negative and the other is not, so they differ.
  const float along = from.distance / (from.distance - to.distance);
  Eigen::Vector3d vertex = lower_end.cast<double>();
  vertex[edge.axis] += along;
  mesh_.vertices.push_back((cell_size_ * vertex).cast<float>());
  mesh_.colours.push_back((1 - along) * from.colour + along * to.colour);
  return next;
}

}  // namespace surefield
