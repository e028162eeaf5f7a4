#include "engine/eval/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <random>

#include "engine/types/error.h"

namespace surefield {

namespace {

using Points = std::vector<Eigen::Vector3d>;

/// For each triangle, the area of all up to it.
std::vector<double> summed_areas(const TriangleMesh& mesh) {
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    sum += (b - a).cross(c - a).norm() / 2;
    sums.push_back(sum);
  }
  return sums;
}

/// In [0, 1), from the generator's bits: the standard's distributions differ between libraries.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// What nanoflann asks of a set of points.
struct PointSet {
  const Points& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using PointTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>,
                                                      PointSet, 3, uint32_t>;

}  // namespace

double surface_area(const TriangleMesh& mesh) {
  return mesh.triangles.empty() ? 0 : summed_areas(mesh).back();
}

Points sample_surface(const TriangleMesh& mesh, std::size_t count, uint32_t seed) {
  const std::vector<double> sums = summed_areas(mesh);
  if (sums.empty() || !(sums.back() > 0)) throw InputError("a mesh has no area left to compare");
  std::mt19937_64 random(seed);
  Points points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = uniform(random) * sums.back();
    const auto found = std::upper_bound(sums.begin(), sums.end() - 1, at) - sums.begin();
    const auto& t = mesh.triangles[static_cast<std::size_t>(found)];
    // The share of area that is nearer to the first corner than s grows as s squared; so s is a square root.
    const double s = std::sqrt(uniform(random));
    const double r = uniform(random);
    points.emplace_back((1 - s) * mesh.vertices[t[0]].cast<double>() +
                        s * (1 - r) * mesh.vertices[t[1]].cast<double>() +
                        s * r * mesh.vertices[t[2]].cast<double>());
  }
  return points;
}

std::vector<double> nearest_distances(const Points& points, const Points& targets) {
  if (targets.empty()) throw InputError("there are no points to compare with");
  const PointSet set{targets};
  const PointTree tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    uint32_t nearest = 0;
    double squared = 0;
    tree.knnSearch(point.data(), 1, &nearest, &squared);
    distances.push_back(std::sqrt(squared));
  }
  return distances;
}

}  // namespace surefield
