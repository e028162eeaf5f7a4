#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/graph/pose_graph.h"
#include "engine/types/relative_pose.h"

namespace surefield::test {

/// A graph whose true poses are known.
struct MadeGraph {
  std::vector<Pose> truth;          ///< the first is where odometry begins
  std::vector<RelativePose> edges;  ///< first those from each vertex to the next, then the loops

  int odometry() const { return static_cast<int>(truth.size()) - 1; }
};

/// Standard deviations of what edges measure.
struct EdgeNoise {
  double metres = 0;
  double radians = 0;
};

/// Cameras on `rings` circles of a sphere or a torus with `per_ring` each, or in rows and layers of a grid,
/// each joined to the next and to its neighbours in the next circle, row and layer.
MadeGraph made_sphere(int rings, int per_ring, const EdgeNoise& noise, uint32_t seed = 1);
MadeGraph made_torus(int rings, int per_ring, const EdgeNoise& noise, uint32_t seed = 1);
MadeGraph made_grid(int columns, int rows, int layers, const EdgeNoise& noise, uint32_t seed = 1);

/// Adds `share` as many false loops as there are edges: any two vertices, any motion of the size of the
/// graph.
void add_false_edges(MadeGraph& graph, double share, uint32_t seed = 2);

/// The pose graph of it from what odometry says; loops have the kernel.
PoseGraph from_odometry(const MadeGraph& made, const RobustKernel& kernel = {});

/// The furthest that a vertex is from its true place, metres.
double furthest_off(const PoseGraph& graph, const std::vector<Pose>& truth);

/// One of the published graphs of ../shared/data, or an empty path (with a message) where it is not there.
std::filesystem::path published_graph(const std::string& name);

/// The pose graph that a g2o file holds; its first vertex is fixed.
PoseGraph read_graph(const std::filesystem::path& file);

}  // namespace surefield::test
