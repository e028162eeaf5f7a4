// Levenberg-Marquardt on a pose graph (Madsen, Nielsen and Tingleff, 2004: damping by the gain ratio).
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/graph/block_system.h"
#include "engine/graph/pose_graph.h"
#include "engine/graph/twist.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kFirstDamping = 1e-4;  // of the diagonal
constexpr double kMostDamping = 1e12;
constexpr double kLeastDamping = 1e-12;
constexpr double kDiagonalFloor = 1e-6;  // of its largest number, for directions that nothing measures
constexpr int kMostChoices = 10;         // of edges
constexpr double kFirstWidening = 16;    // of the chi2 up to which edges are chosen, at first
constexpr double kChoiceNarrowing = 4;   // of it from one choice to the next
constexpr double kLeastStep = 1e-10;     // metres and radians

}  // namespace

/// The normal equations of a graph's unknown vertices.
class GraphSystem {
 public:
  explicit GraphSystem(PoseGraph& graph)
      : graph_(graph),
        numbers_(graph.unknowns()),
        size_(
            static_cast<int>(std::count_if(numbers_.begin(), numbers_.end(), [](int n) { return n >= 0; }))),
        system_(size_, pairs()) {}

  int size() const { return size_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }
  Eigen::VectorXd diagonal() const { return system_.diagonal(); }

  void linearise() {
    system_.set_zero();
    gradient_ = Eigen::VectorXd::Zero(6 * size_);
    for (const PoseGraph::Edge& edge : graph_.edges_) add(edge);
    for (const PoseGraph::Edge& prior : graph_.priors_) add(prior);
  }

  /// The step that the damped equations ask for; false where they have no minimum.
  bool solve(const Eigen::VectorXd& damping, Eigen::VectorXd& step) {
    if (!system_.factorise(damping)) return false;
    step = system_.solve(-gradient_);
    return step.allFinite();
  }

  void move(const Eigen::VectorXd& step) {
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      if (numbers_[i] < 0) continue;
      Pose& pose = graph_.vertices_[i].pose;
      pose = moved(pose, step.segment<6>(6 * numbers_[i]));
    }
  }

 private:
  int number_of(int vertex) const { return vertex == PoseGraph::kWorld ? -1 : numbers_[vertex]; }

  std::vector<std::pair<int, int>> pairs() const {
    std::vector<std::pair<int, int>> result;
    for (const PoseGraph::Edge& edge : graph_.edges_) {
      const int i = number_of(edge.measured.from), j = number_of(edge.measured.to);
      if (i >= 0 && j >= 0) result.emplace_back(i, j);
    }
    return result;
  }

  void add(const PoseGraph::Edge& edge) {
    const int i = number_of(edge.measured.from), j = number_of(edge.measured.to);
    if (i < 0 && j < 0) return;
    const Pose present =
        graph_.pose_or_world(edge.measured.to) * graph_.pose_or_world(edge.measured.from).inverse();
    const Vector6 r = motion_between(edge.measured.pose, present);
    const Matrix6& information = edge.measured.information;
    const double weight = edge.kernel.weight(r.dot(information * r));
    const Matrix6 jacobian = motion_jacobian(r);
    const Matrix6 weighted = weight * jacobian.transpose() * information;
    const Matrix6 block = weighted * jacobian;
    const Vector6 slope = weighted * r;
    const Matrix6 there = adjoint(present);
    if (j >= 0) {
      system_.add(j, j, block);
      gradient_.segment<6>(6 * j) += slope;
    }
    if (i >= 0) {
      const Matrix6 turned = there.transpose() * block;
      system_.add(i, i, turned * there);
      gradient_.segment<6>(6 * i) -= there.transpose() * slope;
      if (j >= 0) system_.add(i, j, -turned);
    }
  }

  PoseGraph& graph_;
  std::vector<int> numbers_;
  int size_;
  BlockSystem<6> system_;
  Eigen::VectorXd gradient_;
};

GraphSolveResult PoseGraph::solve(const GraphSolveOptions& options) {
  GraphSystem system(*this);
  GraphSolveResult result;
  result.initial_cost = result.final_cost = cost();
  result.converged = system.size() == 0;
  double damping = kFirstDamping, raise = 2;
  bool has_moved = true;
  Eigen::VectorXd step, scales;
  while (!result.converged && result.iterations < options.max_iterations && damping < kMostDamping) {
    if (has_moved) {
      system.linearise();
      scales = system.diagonal();
      scales = scales.cwiseMax(std::max(kDiagonalFloor * scales.maxCoeff(), 1e-100));
    }
    ++result.iterations;
    has_moved = false;
    double predicted = 0;
    if (system.solve(damping * scales, step)) {
      const std::vector<Vertex> before = vertices_;
      system.move(step);
      const double moved_cost = cost();
      const double decrease = result.final_cost - moved_cost;
      predicted = 0.5 * step.dot(damping * scales.cwiseProduct(step) - system.gradient());
      has_moved = decrease > 0;
      const double least = options.least_decrease * result.final_cost;
      const bool is_small = (damping < 1 && std::max(decrease, predicted) <= least) ||
                            step.lpNorm<Eigen::Infinity>() < kLeastStep;
      result.converged = is_small;
      if (has_moved) {
        result.final_cost = moved_cost;
        const double gain = 2 * decrease / predicted - 1;
        damping = std::max(kLeastDamping, damping * std::max(1.0 / 3, 1 - gain * gain * gain));
        raise = 2;
      } else {
        vertices_ = before;
      }
    }
    if (!has_moved) {
      damping *= raise;
      raise *= 2;
    }
  }
  return result;
}

GraphSolveResult PoseGraph::solve_without_contradicted(double most_chi2, const GraphSolveOptions& options) {
  if (!(most_chi2 > 0)) throw UsageError("the largest chi2 of an edge must be positive");
  const std::vector<Edge> all = edges_;
  const auto chosen = [&](double most) {
    std::vector<bool> choice;
    for (const Edge& edge : all)
      choice.push_back(edge.kernel.kind == RobustKernel::Kind::None || chi2_of(edge) <= most);
    return choice;
  };
  GraphSolveResult result;
  double widening = kFirstWidening;
  std::vector<bool> before, now = chosen(widening * most_chi2);
  for (int round = 0; round < kMostChoices && (now != before || widening > 1); ++round) {
    edges_.clear();
    for (std::size_t e = 0; e < all.size(); ++e)
      if (now[e]) edges_.push_back(all[e]);
    result = solve(options);
    widening = std::max(1.0, widening / kChoiceNarrowing);
    before = std::exchange(now, chosen(widening * most_chi2));
  }
  edges_ = all;
  return result;
}

}  // namespace surefield
