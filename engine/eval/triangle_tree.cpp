#include "engine/eval/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/types/error.h"

namespace surefield {

namespace {

using Eigen::Vector3d;

constexpr uint32_t kLeafTriangles = 4;

Vector3d nearest_on_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length = along.squaredNorm();
  if (length == 0) return a;
  return a + std::clamp((p - a).dot(along) / length, 0.0, 1.0) * along;
}

/// Over the triangle's inside, that is the foot of the perpendicular; else the nearest point of the three
/// sides.
Vector3d nearest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d n = (b - a).cross(c - a);
  const bool inside = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                      n.dot((a - c).cross(p - c)) >= 0;
  if (inside && n.squaredNorm() > 0) return p - n * (n.dot(p - a) / n.squaredNorm());
  Vector3d best = nearest_on_segment(p, a, b);
  for (const Vector3d& q : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)}) {
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  if (mesh.triangles.empty()) throw InputError("a mesh has no triangles left to compare with");
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vector3d> centres;
  centres.reserve(order_.size());
  for (std::size_t t = 0; t < order_.size(); ++t) {
    centres.emplace_back((corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3);
  }
  nodes_.reserve(order_.size());
  build(0, static_cast<uint32_t>(order_.size()), centres);
}

SurfacePoint TriangleTree::nearest(const Vector3d& point) const {
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  search(0, point, best);
  return best;
}

Vector3d TriangleTree::normal(std::size_t triangle) const {
  const Vector3d a = corner(triangle, 0);
  return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a).normalized();
}

/// Halves the triangles along the longest side of the box of their centres.
uint32_t TriangleTree::build(uint32_t first, uint32_t count, const std::vector<Vector3d>& centres) {
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box box;
  Box centre_box;
  for (uint32_t i = first; i < first + count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) box.extend(corner(order_[i], k));
    centre_box.extend(centres[order_[i]]);
  }
  nodes_[index].box = box;
  if (count <= kLeafTriangles) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return index;
  }
  Eigen::Index axis = 0;
  centre_box.sizes().maxCoeff(&axis);
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](uint32_t a, uint32_t b) { return centres[a][axis] < centres[b][axis]; });
  build(first, count / 2, centres);
  const uint32_t right = build(first + count / 2, count - count / 2, centres);
  nodes_[index].first = right;
  return index;
}

void TriangleTree::search(uint32_t index, const Vector3d& point, SurfacePoint& best) const {
  const Node& node = nodes_[index];
  for (uint32_t i = node.first; i < node.first + node.count; ++i) {
    const uint32_t t = order_[i];
    const Vector3d q = nearest_on_triangle(point, corner(t, 0), corner(t, 1), corner(t, 2));
    const double distance = (q - point).norm();
    if (distance < best.distance) best = {q, t, distance};
  }
  if (node.count > 0) return;
  uint32_t near_child = index + 1;
  uint32_t far_child = node.first;
  double near_distance = nodes_[near_child].box.exteriorDistance(point);
  double far_distance = nodes_[far_child].box.exteriorDistance(point);
  if (far_distance < near_distance) {
    std::swap(near_child, far_child);
    std::swap(near_distance, far_distance);
  }
  if (near_distance < best.distance) search(near_child, point, best);
  if (far_distance < best.distance) search(far_child, point, best);
}

Vector3d TriangleTree::corner(std::size_t triangle, std::size_t k) const {
  return mesh_.vertices[mesh_.triangles[triangle][k]].cast<double>();
}

}  // namespace surefield
