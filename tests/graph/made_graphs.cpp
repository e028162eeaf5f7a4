#include "made_graphs.h"

#include <cmath>
#include <numbers>
#include <random>

#include "../support/input_files.h"
#include "engine/graph/twist.h"
#include "engine/io/g2o_file.h"

namespace surefield::test {

namespace {

using Eigen::Vector3d;
constexpr double kTurn = 2 * std::numbers::pi;

class Noise {
 public:
  explicit Noise(uint32_t seed) : random_(seed) {}

  double uniform() { return (static_cast<double>(random_()) + 0.5) / 4294967296.0; }
  int below(int count) { return static_cast<int>(uniform() * count); }
  double normal() { return std::sqrt(-2 * std::log(uniform())) * std::cos(kTurn * uniform()); }
  Vector3d normals() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

 private:
  std::mt19937 random_;
};

/// World to camera of a camera at `at` that looks along `forward`.
Pose looking(const Vector3d& at, const Vector3d& forward, const Vector3d& up) {
  Eigen::Matrix3d axes;
  axes.col(2) = forward.normalized();
  axes.col(0) = up.cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Pose pose = Pose::Identity();
  pose.linear() = axes.transpose();
  pose.translation() = -axes.transpose() * at;
  return pose;
}

class Maker {
 public:
  Maker(std::vector<Pose> truth, const EdgeNoise& noise, uint32_t seed) : noise_(noise), random_(seed) {
    made_.truth = std::move(truth);
    for (int i = 0; i < made_.odometry(); ++i) measure(i, i + 1);
  }

  /// A loop, where it is none that odometry has.
  void join(int from, int to) {
    if (to > from + 1) measure(from, to);
  }

  MadeGraph take() { return std::move(made_); }

 private:
  void measure(int from, int to) {
    Vector6 error;
    error << noise_.metres * random_.normals(), noise_.radians * random_.normals();
    RelativePose edge{from, to, moved(made_.truth[to] * made_.truth[from].inverse(), error), {}};
    edge.information = Matrix6::Identity();
    edge.information.topLeftCorner<3, 3>() /= std::pow(std::max(noise_.metres, 1e-3), 2);
    edge.information.bottomRightCorner<3, 3>() /= std::pow(std::max(noise_.radians, 1e-3), 2);
    made_.edges.push_back(edge);
  }

  MadeGraph made_;
  EdgeNoise noise_;
  Noise random_;
};

MadeGraph rings_joined(const std::vector<Pose>& truth, int per_ring, const EdgeNoise& noise, uint32_t seed) {
  Maker maker(truth, noise, seed);
  for (int i = 0; i + per_ring < static_cast<int>(truth.size()); ++i) maker.join(i, i + per_ring);
  return maker.take();
}

}  // namespace

MadeGraph made_sphere(int rings, int per_ring, const EdgeNoise& noise, uint32_t seed) {
  const double radius = 5;
  std::vector<Pose> truth;
  for (int i = 0; i < rings * per_ring; ++i) {
    const double height = (i + 0.5) / (rings * per_ring) * 2 - 1, angle = kTurn * i / per_ring;
    const double aside = std::sqrt(1 - height * height);
    const Vector3d at(aside * std::cos(angle), aside * std::sin(angle), height);
    truth.push_back(looking(radius * at, at, Vector3d(0, 0, 1)));
  }
  return rings_joined(truth, per_ring, noise, seed);
}

MadeGraph made_torus(int rings, int per_ring, const EdgeNoise& noise, uint32_t seed) {
  std::vector<Pose> truth;
  for (int i = 0; i < rings * per_ring; ++i) {
    const double around = kTurn * i / (rings * per_ring), within = kTurn * i / per_ring;
    const Vector3d out(std::cos(around), std::sin(around), 0), up(0, 0, 1);
    const Vector3d away = std::cos(within) * out + std::sin(within) * up;
    truth.push_back(looking(5 * out + 2 * away, away, out.cross(up)));
  }
  return rings_joined(truth, per_ring, noise, seed);
}

MadeGraph made_grid(int columns, int rows, int layers, const EdgeNoise& noise, uint32_t seed) {
  // There and back along rows, so that odometry goes from each place to one beside it.
  const auto number = [&](int x, int y, int z) {
    const int row = z % 2 ? rows - 1 - y : y;
    const int before = z * rows + row;
    return before * columns + (before % 2 ? columns - 1 - x : x);
  };
  std::vector<Pose> truth(columns * rows * layers);
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x)
        truth[number(x, y, z)] =
            looking(Vector3d(x, y, z), Vector3d(std::cos(x), std::sin(x + y), 0.3 * z), {0, 0, 1});
  Maker maker(truth, noise, seed);
  const auto join = [&](int a, int b) { maker.join(std::min(a, b), std::max(a, b)); };
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        if (y + 1 < rows) join(number(x, y, z), number(x, y + 1, z));
        if (z + 1 < layers) join(number(x, y, z), number(x, y, z + 1));
      }
  return maker.take();
}

void add_false_edges(MadeGraph& graph, double share, uint32_t seed) {
  Noise random(seed);
  const int count = static_cast<int>(share * static_cast<double>(graph.edges.size()));
  const int vertices = static_cast<int>(graph.truth.size());
  for (int i = 0; i < count; ++i) {
    const int from = random.below(vertices - 2), to = from + 2 + random.below(vertices - 2 - from);
    Vector6 motion;
    motion << 3 * random.normals(), random.normals();
    graph.edges.push_back({from, to, moved(Pose::Identity(), motion), graph.edges.front().information});
  }
}

PoseGraph from_odometry(const MadeGraph& made, const RobustKernel& kernel) {
  PoseGraph graph;
  graph.add_vertex(made.truth.front(), true);
  for (int i = 0; i < made.odometry(); ++i) graph.add_vertex(made.edges[i].pose * graph.pose(i));
  for (int e = 0; e < static_cast<int>(made.edges.size()); ++e)
    graph.add_edge(made.edges[e], e < made.odometry() ? RobustKernel{} : kernel);
  return graph;
}

double furthest_off(const PoseGraph& graph, const std::vector<Pose>& truth) {
  double most = 0;
  for (int i = 0; i < graph.vertices(); ++i)
    most = std::max(most, (graph.pose(i).inverse().translation() - truth[i].inverse().translation()).norm());
  return most;
}

std::filesystem::path published_graph(const std::string& name) {
  const std::filesystem::path folder = real_clip("graphs");
  return folder.empty() ? folder : folder / (name + ".g2o");
}

PoseGraph read_graph(const std::filesystem::path& file) {
  const G2oGraph read = read_g2o(file);
  PoseGraph graph;
  for (const G2oGraph::Vertex& vertex : read.vertices) graph.add_vertex(vertex.pose, graph.vertices() == 0);
  for (const RelativePose& edge : read.edges) graph.add_edge(edge);
  return graph;
}

}  // namespace surefield::test
