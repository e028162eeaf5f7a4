#include "tools/export/run_graph.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "engine/io/files.h"
#include "engine/session/loop_table.h"
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

/// The vertex of each keyframe by its frame's index; -1 for one whose pose is not known.
std::map<int, int> vertices_of(const RunFolder& run) {
  std::map<int, int> vertices;
  std::size_t keyframe = 0;
  int vertex = 0;
  for (const nlohmann::json& frame : run.metrics["per_frame"]) {
    if (keyframe == run.keyframes.size() || frame.value("keyframe", nlohmann::json(false)) != true) continue;
    const bool is_known = run.keyframes[keyframe++].is_finite();
    vertices[frame.value("index", -1)] = is_known ? vertex++ : -1;
  }
  return vertices;
}

void add_loops(G2oGraph& graph, const RunFolder& run) {
  const auto file = run.path / "loops.csv";
  if (!file_exists(file)) return;
  const std::map<int, int> vertices = vertices_of(run);
  const auto vertex_of = [&](int frame) {
    const auto found = vertices.find(frame);
    if (found == vertices.end()) throw InputError(file, fmt::format("frame {} is no keyframe", frame));
    return found->second;
  };
  for (const StoredLoop& loop : read_loops(file)) {
    if (!loop.accepted) continue;
    RelativePose edge = loop.measured;
    if (edge.information.isZero(0))
      throw InputError(file, "has no information of its loops; run the sequence again");
    edge.from = vertex_of(edge.from);
    edge.to = vertex_of(edge.to);
    if (edge.from >= 0 && edge.to >= 0) graph.edges.push_back(edge);
  }
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
  add_loops(graph, run);
  return graph;
}

}  // namespace surefield
