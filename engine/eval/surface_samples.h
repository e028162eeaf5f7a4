#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "engine/formats/triangle_mesh.h"

namespace surefield {

/// Area of all triangles, square metres.
double surface_area(const TriangleMesh& mesh);

/// `count` points that are spread evenly over the area of a mesh: independent, always the same ones for a
/// seed. Throws InputError when the mesh has no area.
std::vector<Eigen::Vector3d> sample_surface(const TriangleMesh& mesh, std::size_t count, uint32_t seed);

/// The distance of each point to the nearest one of `targets`. Throws InputError when there are none.
std::vector<double> nearest_distances(const std::vector<Eigen::Vector3d>& points,
                                      const std::vector<Eigen::Vector3d>& targets);

}  // namespace surefield
