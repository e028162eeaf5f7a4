#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/formats/triangle_mesh.h"

namespace surefield {

/// The place on a mesh that is nearest to a point.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::size_t triangle = 0;
  double distance = 0;  ///< metres
};

/// Finds the exactly nearest point of a mesh: a tree of axis-aligned boxes around its triangles.
class TriangleTree {
 public:
  /// `mesh` must outlive the tree. Throws InputError when it has no triangle.
  explicit TriangleTree(const TriangleMesh& mesh);

  SurfacePoint nearest(const Eigen::Vector3d& point) const;

  /// Unit normal of a triangle, on the side from which it is counter-clockwise; zero where it has no area.
  Eigen::Vector3d normal(std::size_t triangle) const;

 private:
  using Box = Eigen::AlignedBox3d;

  /// A leaf holds triangles order_[first .. first + count); an inner node has count 0, its left child next to
  /// it and its right child at `first`.
  struct Node {
    Box box;
    uint32_t first = 0;
    uint32_t count = 0;
  };

  uint32_t build(uint32_t first, uint32_t count, const std::vector<Eigen::Vector3d>& centres);
  void search(uint32_t index, const Eigen::Vector3d& point, SurfacePoint& best) const;
  Eigen::Vector3d corner(std::size_t triangle, std::size_t k) const;

  const TriangleMesh& mesh_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace surefield
