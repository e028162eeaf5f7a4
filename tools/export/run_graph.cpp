#include "tools/export/run_graph.h"

#include <cmath>
#include <numbers>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kOdometryMetres = 0.01, kOdometryRadians = 0.5 * std::numbers::pi / 180;

Matrix6 odometry_information() {
  Vector6 diagonal;
  diagonal << Eigen::Vector3d::Constant(1 / std::pow(kOdometryMetres, 2)),
      Eigen::Vector3d::Constant(1 / std::pow(kOdometryRadians, 2));
  return diagonal.asDiagonal();
}

}  // namespace

G2oGraph graph_of_run(const RunFolder& run) {
  G2oGraph graph;
  for (std::size_t k = 0; k < run.keyframes.size(); ++k) {
    const StampedPose& keyframe = run.keyframes[k];
    if (!keyframe.is_finite()) continue;
    const auto id = static_cast<std::int64_t>(k);
    graph.vertices.push_back({id, keyframe.camera_to_world.inverse(), graph.vertices.empty()});
  }
  if (graph.vertices.empty())
    throw InputError(run.path / "keyframes.txt", "has no keyframe whose pose is known");
  for (int i = 0; i + 1 < static_cast<int>(graph.vertices.size()); ++i) {
    const Pose motion = graph.vertices[i + 1].pose * graph.vertices[i].pose.inverse();
    graph.edges.push_back({i, i + 1, motion, odometry_information()});
  }
  return graph;
}

}  // namespace surefield
