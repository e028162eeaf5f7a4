// Where to start: rotations by chordal relaxation (Martinec and Pajdla, 2007), then translations, both
// linear. Edges with a kernel lose weight gradually, from a kernel that is wide enough for all of them to
// their own (graduated non-convexity; Black and Rangarajan, 1996). Edges with a kernel that no other confirms
// take no part where most are confirmed: many false ones at full weight bend a large graph so much that right
// ones seem false.
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/graph/agreeing_loops.h"
#include "engine/graph/block_system.h"
#include "engine/graph/pose_graph.h"
#include "engine/graph/twist.h"

namespace surefield {

namespace {

constexpr double kAnchor = 1e-9;  // of the largest weight: draws to the present pose what nothing measures
constexpr double kNarrowing = 2;  // of the square of a kernel's scale from one round to the next

/// Geman and McClure's weight of an edge whose kernel's squared scale is `widening` times as large.
double gradual_weight(const RobustKernel& kernel, double chi2, double widening) {
  if (kernel.kind == RobustKernel::Kind::None) return 1;
  const double square = widening * kernel.scale * kernel.scale;
  return std::pow(square / (square + chi2), 2);
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::DiagonalMatrix<double, 3>(1, 1, sign) * svd.matrixV().transpose();
}

/// The edges that a start rests on.
std::vector<bool> trusted_edges(const PoseGraph& graph) {
  std::vector<RelativePose> believed, loops;
  for (int e = 0; e < graph.edges(); ++e)
    (graph.kernel(e).kind == RobustKernel::Kind::None ? believed : loops).push_back(graph.edge(e));
  const std::vector<bool> confirmed = agreeing_loops(believed, loops, graph.vertices());
  const bool are_most = 2 * std::count(confirmed.begin(), confirmed.end(), true) > std::ssize(confirmed);
  std::vector<bool> trusted(graph.edges(), true);
  for (int e = 0, loop = 0; e < graph.edges() && are_most; ++e)
    if (graph.kernel(e).kind != RobustKernel::Kind::None) trusted[e] = confirmed[loop++];
  return trusted;
}

}  // namespace

/// The two linear problems of a start. Each term of an edge is |x_j - B x_i - c|^2 with the weight W.
class GraphStart {
 public:
  explicit GraphStart(PoseGraph& graph)
      : graph_(graph),
        numbers_(graph.unknowns()),
        size_(
            static_cast<int>(std::count_if(numbers_.begin(), numbers_.end(), [](int n) { return n >= 0; }))) {
    const std::vector<bool> trusted = trusted_edges(graph);
    for (int e = 0; e < graph.edges(); ++e)
      if (trusted[e]) edges_.push_back(graph.edges_[e]);
    edges_.insert(edges_.end(), graph.priors_.begin(), graph.priors_.end());
    std::vector<std::pair<int, int>> pairs;
    for (const PoseGraph::Edge& edge : edges_) {
      const int i = number_of(edge.measured.from), j = number_of(edge.measured.to);
      if (i >= 0 && j >= 0) pairs.emplace_back(i, j);
    }
    system_.emplace(size_, pairs);
    weights_.assign(edges_.size(), 1);
  }

  void find() {
    if (size_ == 0) return;
    graduate([&] { turn(); }, [&](const PoseGraph::Edge& edge) { return turn_chi2(edge); });
    kept_ = weights_;
    graduate([&] { shift(); }, [&](const PoseGraph::Edge& edge) { return graph_.chi2_of(edge); });
  }

 private:
  using Terms = BlockSystem<3>::Block;

  int number_of(int vertex) const { return vertex == PoseGraph::kWorld ? -1 : numbers_[vertex]; }

  /// Solves again and again while the kernels narrow to their own width.
  template <typename Solve, typename Chi2>
  void graduate(Solve solve, Chi2 chi2) {
    solve();
    double widening = 0;
    for (const PoseGraph::Edge& edge : edges_)
      if (edge.kernel.kind != RobustKernel::Kind::None)
        widening = std::max(widening, chi2(edge) / (edge.kernel.scale * edge.kernel.scale));
    while (widening > 1) {
      for (std::size_t e = 0; e < edges_.size(); ++e)
        weights_[e] =
            (kept_.empty() ? 1 : kept_[e]) * gradual_weight(edges_[e].kernel, chi2(edges_[e]), widening);
      solve();
      widening /= kNarrowing;
    }
  }

  static double turn_weight(const RelativePose& measured) {
    return measured.information.bottomRightCorner<3, 3>().trace() / 3;
  }

  double turn_chi2(const PoseGraph::Edge& edge) const {
    return turn_weight(edge.measured) * graph_.residual(edge).tail<3>().squaredNorm();
  }

  void add(const PoseGraph::Edge& edge, const Terms& b, const Terms& weight) {
    const int i = number_of(edge.measured.from), j = number_of(edge.measured.to);
    if (j >= 0) system_->add(j, j, weight);
    if (i >= 0) system_->add(i, i, b.transpose() * weight * b);
    if (i >= 0 && j >= 0) system_->add(i, j, -b.transpose() * weight);
  }

  /// Draws everything a little to `present` and solves.
  Eigen::MatrixXd solved(const Eigen::MatrixXd& right, const Eigen::MatrixXd& present) {
    const double anchor = kAnchor * std::max(system_->diagonal().maxCoeff(), 1e-100);
    if (!system_->factorise(Eigen::VectorXd::Constant(3 * size_, anchor))) return present;
    return system_->solve(right + anchor * present);
  }

  void turn() {
    system_->set_zero();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3 * size_, 3), present(3 * size_, 3);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const RelativePose& measured = edges_[e].measured;
      const int i = number_of(measured.from), j = number_of(measured.to);
      const Terms b = measured.pose.linear();
      const double weight = weights_[e] * turn_weight(measured);
      add(edges_[e], b, weight * Terms::Identity());
      if (j >= 0 && i < 0)
        right.middleRows<3>(3 * j) += weight * b * graph_.pose_or_world(measured.from).linear();
      if (i >= 0 && j < 0)
        right.middleRows<3>(3 * i) += weight * b.transpose() * graph_.pose(measured.to).linear();
    }
    for (std::size_t k = 0; k < numbers_.size(); ++k)
      if (numbers_[k] >= 0) present.middleRows<3>(3 * numbers_[k]) = graph_.vertices_[k].pose.linear();
    const Eigen::MatrixXd x = solved(right, present);
    for (std::size_t k = 0; k < numbers_.size(); ++k)
      if (numbers_[k] >= 0)
        graph_.vertices_[k].pose.linear() = nearest_rotation(x.middleRows<3>(3 * numbers_[k]));
  }

  void shift() {
    system_->set_zero();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3 * size_, 1), present(3 * size_, 1);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const RelativePose& measured = edges_[e].measured;
      const int i = number_of(measured.from), j = number_of(measured.to);
      const Pose from = graph_.pose_or_world(measured.from), &to = graph_.pose(measured.to);
      const Terms b = to.linear() * from.linear().transpose();
      const Terms weight = weights_[e] * measured.information.topLeftCorner<3, 3>();
      add(edges_[e], b, weight);
      Eigen::Vector3d c = b * measured.pose.linear().transpose() * measured.pose.translation();
      if (i < 0) c += b * from.translation();
      if (j < 0) c -= to.translation();
      if (j >= 0) right.middleRows<3>(3 * j) += weight * c;
      if (i >= 0) right.middleRows<3>(3 * i) -= b.transpose() * weight * c;
    }
    for (std::size_t k = 0; k < numbers_.size(); ++k)
      if (numbers_[k] >= 0) present.middleRows<3>(3 * numbers_[k]) = graph_.vertices_[k].pose.translation();
    const Eigen::MatrixXd x = solved(right, present);
    for (std::size_t k = 0; k < numbers_.size(); ++k)
      if (numbers_[k] >= 0) graph_.vertices_[k].pose.translation() = x.middleRows<3>(3 * numbers_[k]);
  }

  PoseGraph& graph_;
  std::vector<int> numbers_;
  int size_;
  std::vector<PoseGraph::Edge> edges_;  ///< that are trusted, and the priors
  std::optional<BlockSystem<3>> system_;
  std::vector<double> weights_;  ///< of the edges
  std::vector<double> kept_;     ///< what the rotations have left of the weights
};

void PoseGraph::initialise_from_edges() {
  GraphStart(*this).find();
}

}  // namespace surefield
