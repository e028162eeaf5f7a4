#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/eval/mesh_views.h"

namespace surefield {

/// How far two surfaces are apart.
struct SurfaceDistances {
  double accuracy = 0;          ///< mean distance from the reconstruction to the truth, metres
  double completion = 0;        ///< mean distance from the truth to the reconstruction, metres
  double completion_ratio = 0;  ///< part of the truth with less than 5 cm to the reconstruction
  double precision = 0;         ///< part of the reconstruction with less than 1 cm to the truth
  double recall = 0;            ///< part of the truth with less than 1 cm to the reconstruction

  /// F1 at 1 cm: the harmonic mean of precision and recall.
  double f1() const { return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0; }
};

/// What is measured of two sets of distances, metres: from samples of the reconstruction to the truth, and
/// back. Neither may be empty.
SurfaceDistances summarise_distances(const std::vector<double>& to_truth,
                                     const std::vector<double>& to_reconstruction);

/// How to compare a reconstruction with the truth.
struct MeshComparison {
  /// From the reconstruction's frame near to the truth's; the rest is found by ICP.
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  /// What none of these sees is culled from both meshes. Without any, nothing is.
  std::vector<Camera> cameras;
  std::size_t samples = 200000;  ///< points on each mesh
  uint32_t seed = 1;
};

/// How a mesh compares with the truth; docs/evaluation.md defines it all.
struct MeshMetrics {
  SurfaceDistances nearest_triangle;     ///< from samples to the other mesh's surface: for judging
  SurfaceDistances point_to_point;       ///< between the two sets of samples: for comparison with papers
  std::optional<DepthDifference> depth;  ///< where there are cameras
  double area = 0;                       ///< of the reconstruction after culling, square metres
  double truth_area = 0;                 ///< of the truth after culling, square metres
  double kept = 1;                       ///< part of the reconstruction's area that was not culled
  double truth_kept = 1;                 ///< part of the truth's area that was not culled
  Eigen::Isometry3d alignment = Eigen::Isometry3d::Identity();  ///< from the reconstruction to the truth
};

/// Aligns, culls, samples and measures. Throws InputError when a mesh has no area left.
MeshMetrics compare_meshes(const TriangleMesh& reconstruction, const TriangleMesh& truth,
                           const MeshComparison& comparison);

/// How far the centres of Gaussians lie from a surface, metres.
struct CentreDistances {
  double mean = 0;        ///< from the centres to the surface
  double median = 0;      ///< the same
  double to_centres = 0;  ///< mean, from samples of the surface that the cameras see to the nearest centre
  std::size_t centres = 0;

  double chamfer() const { return mean + to_centres; }
};

/// Aligns the centres to the surface and measures; those that no camera sees are left out. Throws InputError
/// when nothing is left.
CentreDistances compare_centres(const std::vector<Eigen::Vector3d>& centres, const TriangleMesh& truth,
                                const MeshComparison& comparison);

}  // namespace surefield
