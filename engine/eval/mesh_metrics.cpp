#include "engine/eval/mesh_metrics.h"

#include <algorithm>
#include <numeric>

#include "engine/eval/mesh_alignment.h"
#include "engine/eval/surface_samples.h"
#include "engine/eval/triangle_tree.h"
#include "engine/types/error.h"
#include "engine/types/median.h"

namespace surefield {

namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kCompletionDistance = 0.05;  // metres; of the completion ratio
constexpr double kMatch = 0.01;               // metres; of precision and recall
constexpr std::size_t kIcpSamples = 20000;    // points on the reconstruction

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double part_below(const std::vector<double>& values, double limit) {
  const auto count = std::count_if(values.begin(), values.end(), [&](double x) { return x < limit; });
  return static_cast<double>(count) / static_cast<double>(values.size());
}

std::vector<double> surface_distances(const Points& points, const TriangleTree& surface) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector3d& point : points) distances.push_back(surface.nearest(point).distance);
  return distances;
}

TriangleMesh moved(const TriangleMesh& mesh, const Eigen::Isometry3d& motion) {
  TriangleMesh result{mesh.vertices, {}, mesh.triangles};
  for (Eigen::Vector3f& vertex : result.vertices) {
    vertex = (motion * vertex.cast<double>()).cast<float>();
  }
  return result;
}

/// Both protocols, between samples of the two meshes.
void measure_distances(const TriangleMesh& reconstruction, const TriangleMesh& truth,
                       const MeshComparison& comparison, MeshMetrics& metrics) {
  const Points ours = sample_surface(reconstruction, comparison.samples, comparison.seed);
  const Points theirs = sample_surface(truth, comparison.samples, comparison.seed + 1);
  metrics.point_to_point =
      summarise_distances(nearest_distances(ours, theirs), nearest_distances(theirs, ours));
  metrics.nearest_triangle = summarise_distances(surface_distances(ours, TriangleTree(truth)),
                                                 surface_distances(theirs, TriangleTree(reconstruction)));
}

}  // namespace

SurfaceDistances summarise_distances(const std::vector<double>& to_truth,
                                     const std::vector<double>& to_reconstruction) {
  return {.accuracy = mean(to_truth),
          .completion = mean(to_reconstruction),
          .completion_ratio = part_below(to_reconstruction, kCompletionDistance),
          .precision = part_below(to_truth, kMatch),
          .recall = part_below(to_reconstruction, kMatch)};
}

MeshMetrics compare_meshes(const TriangleMesh& reconstruction, const TriangleMesh& truth,
                           const MeshComparison& comparison) {
  MeshMetrics metrics;
  metrics.alignment = align_to_surface(sample_surface(reconstruction, kIcpSamples, comparison.seed),
                                       TriangleTree(truth), comparison.start);
  TriangleMesh ours = moved(reconstruction, metrics.alignment);
  if (comparison.cameras.empty()) {
    metrics.area = surface_area(ours);
    metrics.truth_area = surface_area(truth);
    measure_distances(ours, truth, comparison, metrics);
    return metrics;
  }
  const MeshViews views(truth, comparison.cameras);
  metrics.depth = views.compare_depth(ours);
  const TriangleMesh seen = views.visible_part(ours);
  const TriangleMesh truth_seen = views.visible_part(truth);
  metrics.area = surface_area(seen);
  metrics.truth_area = surface_area(truth_seen);
  metrics.kept = metrics.area / surface_area(ours);
  metrics.truth_kept = metrics.truth_area / surface_area(truth);
  measure_distances(seen, truth_seen, comparison, metrics);
  return metrics;
}

CentreDistances compare_centres(const Points& centres, const TriangleMesh& truth,
                                const MeshComparison& comparison) {
  const TriangleTree surface(truth);
  // Evenly picked, as many as ICP takes of a mesh.
  Points some;
  for (std::size_t i = 0; i < centres.size(); i += 1 + centres.size() / kIcpSamples) {
    some.push_back(centres[i]);
  }
  const Eigen::Isometry3d alignment = align_to_surface(some, surface, comparison.start);
  const MeshViews views(truth, comparison.cameras);
  const bool culls = !comparison.cameras.empty();
  Points ours;
  for (const Eigen::Vector3d& centre : centres) {
    const Eigen::Vector3d place = alignment * centre;
    if (!culls || views.sees(place)) ours.push_back(place);
  }
  if (ours.empty()) throw InputError("no Gaussian of the map lies where the cameras look");
  const TriangleMesh seen = culls ? views.visible_part(truth) : truth;
  const std::vector<double> to_surface = surface_distances(ours, surface);
  const Points samples = sample_surface(seen, comparison.samples, comparison.seed);
  return {mean(to_surface), median(to_surface), mean(nearest_distances(samples, ours)), ours.size()};
}

}  // namespace surefield
