#include "engine/graph/pose_graph.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>
#include <string>

#include "engine/graph/twist.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kLeastEigenvalue = 1e-10;  // of the largest one, of a direction that is measured

void require_finite(const Pose& pose) {
  if (!pose.matrix().allFinite()) throw UsageError("a pose of the pose graph is not finite");
}

void require_finite(const Matrix6& information) {
  if (!information.allFinite()) throw UsageError("an information matrix of the pose graph is not finite");
}

/// The root of the set that holds `vertex`; paths are halved on the way.
int root_of(std::vector<int>& parents, int vertex) {
  while (parents[vertex] != vertex) vertex = parents[vertex] = parents[parents[vertex]];
  return vertex;
}

}  // namespace

double RobustKernel::cost(double chi2) const {
  const double square = scale * scale;
  if (kind == Kind::Cauchy) return square * std::log1p(chi2 / square);
  if (kind == Kind::DynamicCovariance && chi2 > square)
    return 3 * square - 4 * square * square / (square + chi2);
  return chi2;
}

double RobustKernel::weight(double chi2) const {
  const double square = scale * scale;
  if (kind == Kind::Cauchy) return square / (square + chi2);
  if (kind == Kind::DynamicCovariance && chi2 > square) {
    const double share = 2 * square / (square + chi2);
    return share * share;
  }
  return 1;
}

RelativePose relative_pose_of(int from, int to, const Pose& at, const Matrix6& h, const Vector6& b) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(h);
  const double least = kLeastEigenvalue * eigen.eigenvalues()[5];
  RelativePose result{from, to, at, Matrix6::Zero()};
  Vector6 step = Vector6::Zero();
  for (int i = 0; i < 6; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (!(value > least)) continue;
    const Vector6 direction = eigen.eigenvectors().col(i);
    step -= direction * (direction.dot(b) / value);
    result.information += value * direction * direction.transpose();
  }
  result.pose = moved(at, step);
  return result;
}

int PoseGraph::add_vertex(const Pose& world_to_camera, bool fixed) {
  require_finite(world_to_camera);
  vertices_.push_back({world_to_camera, fixed});
  return vertices() - 1;
}

void PoseGraph::set_fixed(int vertex, bool fixed) {
  vertex_at(vertex);
  vertices_[vertex].fixed = fixed;
}

void PoseGraph::set_pose(int vertex, const Pose& world_to_camera) {
  vertex_at(vertex);
  require_finite(world_to_camera);
  vertices_[vertex].pose = world_to_camera;
}

int PoseGraph::add_edge(const RelativePose& edge, const RobustKernel& kernel) {
  vertex_at(edge.from);
  vertex_at(edge.to);
  if (edge.from == edge.to) throw UsageError("an edge of the pose graph joins a vertex to itself");
  require_finite(edge.pose);
  require_finite(edge.information);
  if (kernel.kind != RobustKernel::Kind::None && !(kernel.scale > 0))
    throw UsageError("the scale of a robust kernel must be positive");
  edges_.push_back({edge, kernel});
  return edges() - 1;
}

void PoseGraph::remove_edge(int edge) {
  edge_at(edge);
  edges_.erase(edges_.begin() + edge);
}

void PoseGraph::add_prior(int vertex, const Pose& at, const Matrix6& information) {
  vertex_at(vertex);
  require_finite(at);
  require_finite(information);
  priors_.push_back({{kWorld, vertex, at, information}, {}});
}

const PoseGraph::Vertex& PoseGraph::vertex_at(int vertex) const {
  if (vertex < 0 || vertex >= vertices())
    throw UsageError("the pose graph has no vertex " + std::to_string(vertex));
  return vertices_[vertex];
}

const PoseGraph::Edge& PoseGraph::edge_at(int edge) const {
  if (edge < 0 || edge >= edges()) throw UsageError("the pose graph has no edge " + std::to_string(edge));
  return edges_[edge];
}

const Pose& PoseGraph::pose(int vertex) const {
  return vertex_at(vertex).pose;
}
bool PoseGraph::fixed(int vertex) const {
  return vertex_at(vertex).fixed;
}
const RelativePose& PoseGraph::edge(int edge) const {
  return edge_at(edge).measured;
}
const RobustKernel& PoseGraph::kernel(int edge) const {
  return edge_at(edge).kernel;
}

Pose PoseGraph::pose_or_world(int vertex) const {
  return vertex == kWorld ? Pose::Identity() : vertices_[vertex].pose;
}

Vector6 PoseGraph::residual(const Edge& edge) const {
  const RelativePose& measured = edge.measured;
  const Pose present = pose_or_world(measured.to) * pose_or_world(measured.from).inverse();
  return motion_between(measured.pose, present);
}

double PoseGraph::chi2_of(const Edge& edge) const {
  const Vector6 r = residual(edge);
  return r.dot(edge.measured.information * r);
}

double PoseGraph::chi2(int edge) const {
  return chi2_of(edge_at(edge));
}

double PoseGraph::cost() const {
  double sum = 0;
  for (const Edge& edge : edges_) sum += edge.kernel.cost(chi2_of(edge));
  for (const Edge& prior : priors_) sum += chi2_of(prior);
  return sum / 2;
}

std::vector<int> PoseGraph::unknowns() const {
  std::vector<int> parents(vertices_.size());
  std::iota(parents.begin(), parents.end(), 0);
  for (const Edge& edge : edges_) {
    const int a = root_of(parents, edge.measured.from), b = root_of(parents, edge.measured.to);
    parents[std::max(a, b)] = std::min(a, b);
  }
  std::vector<bool> is_held(vertices_.size(), false);
  for (int i = 0; i < vertices(); ++i)
    if (vertices_[i].fixed) is_held[root_of(parents, i)] = true;
  for (const Edge& prior : priors_) is_held[root_of(parents, prior.measured.to)] = true;
  std::vector<int> numbers(vertices_.size(), -1);
  int count = 0;
  for (int i = 0; i < vertices(); ++i) {
    // A root is the first vertex of its part.
    const bool holds_its_part = parents[i] == i && !is_held[i];
    if (!vertices_[i].fixed && !holds_its_part) numbers[i] = count++;
  }
  return numbers;
}

}  // namespace surefield
