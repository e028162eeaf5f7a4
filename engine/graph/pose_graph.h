#pragma once

#include <vector>

#include "engine/types/relative_pose.h"

namespace surefield {

/// How much an edge counts that the others contradict. With x its weighted squared residual, chi2:
/// `Cauchy` costs s^2 log(1 + x / s^2); `DynamicCovariance` (Agarwal, 2013) costs x up to Phi = s^2, and
/// beyond it (3 Phi - 4 Phi^2 / (Phi + x)): its covariance is scaled by ((Phi + x) / 2 Phi)^2. The scale s is
/// in standard deviations.
struct RobustKernel {
  enum class Kind { None, Cauchy, DynamicCovariance };
  Kind kind = Kind::None;
  double scale = 1;

  double cost(double chi2) const;    ///< chi2 without a kernel
  double weight(double chi2) const;  ///< the derivative of cost(): 1 without a kernel
};

struct GraphSolveOptions {
  int max_iterations = 100;
  /// Solved when a step lowers the cost by less than this part of it.
  double least_decrease = 1e-9;
};

struct GraphSolveResult {
  int iterations = 0;       ///< linear systems solved
  double initial_cost = 0;  ///< half the sum of what edges and priors cost
  double final_cost = 0;
  bool converged = false;
};

/// What a pairwise alignment says, linearised at the motion `at` of the pair: its cost is d'Hd / 2 + b'd for
/// a small motion d of it (twist.h), so that it measures moved(at, -H^-1 b) with the information H.
/// Directions with less than 1e-10 of H's largest eigenvalue (each in its own unit) are taken as not
/// measured. The way back, aligned on Z^-1, is an edge of its own with `from` and `to` exchanged.
RelativePose relative_pose_of(int from, int to, const Pose& at, const Matrix6& h, const Vector6& b);

/// A graph of poses T_k, world to camera, and of measured motions between them.
///
/// The residual of an edge with the measured motion Z is r = (tau, phi), the motion from Z to T_j T_i^-1:
///   D = T_j T_i^-1 Z^-1,  r = (t(D), Log R(D)),
/// its cost r' Omega r / 2. Perturbed from the left, J_j = [I, -[tau]x; 0, Jl^-1(phi)], J_i = -J_j Ad(T_j
/// T_i^-1), which is the plain I and -Ad(Z) at r = 0. In g2o's terms (EDGE_SE3:QUAT) D is the inverse of
/// the error M^-1 X_i^-1 X_j: the cost is that of g2o, of Ceres' pose_graph_3d and of GTSAM's geodesic one
/// where Omega has no terms between translation and rotation and its translation is a multiple of the
/// identity, up to how each parametrises rotations; otherwise it agrees to second order in the residual
/// (engine/io/g2o_file.h).
///
/// Every sum has a fixed order and nothing runs in parallel: the same graph gives the same bits. Not
/// thread-safe. Calls with an index that there is not, a pose or an information matrix that is not finite, or
/// an edge from a vertex to itself throw UsageError, and nothing has changed.
class PoseGraph {
 public:
  /// Vertices count from 0. A fixed one keeps its pose.
  int add_vertex(const Pose& world_to_camera, bool fixed = false);
  void set_fixed(int vertex, bool fixed);
  void set_pose(int vertex, const Pose& world_to_camera);

  /// Edges count from 0. Several may join the same two vertices.
  int add_edge(const RelativePose& edge, const RobustKernel& kernel = {});
  /// The edges behind it move down by one.
  void remove_edge(int edge);

  /// Draws a vertex to the pose `at`: costs r' Omega r / 2 of the motion r from `at` to its pose.
  void add_prior(int vertex, const Pose& at, const Matrix6& information);

  int vertices() const { return static_cast<int>(vertices_.size()); }
  int edges() const { return static_cast<int>(edges_.size()); }
  const Pose& pose(int vertex) const;
  bool fixed(int vertex) const;
  const RelativePose& edge(int edge) const;
  const RobustKernel& kernel(int edge) const;

  /// r' Omega r of an edge at the present poses, without its kernel. Of an edge whose information is
  /// right it is below 16.8 in 99 of 100 cases.
  double chi2(int edge) const;
  /// Half the sum of all costs, with kernels.
  double cost() const;

  /// Moves all vertices but the fixed ones to where edges without a kernel, and of the others as many as
  /// agree, want them, wherever they were: rotations by linear least squares on their matrices, then
  /// translations, both again with less and less weight for edges with a kernel that do not fit. Where more
  /// than half of the edges with a kernel are each confirmed by another (agreeing_loops.h), the rest takes no
  /// part. A start for solve() where the poses carry much drift. Parts of the graph as for solve().
  void initialise_from_edges();

  /// Levenberg-Marquardt. Whatever is not joined to a fixed vertex or one with a prior has its first vertex
  /// held, vertices without edges stay. A graph without any unknown is solved. The poses never get worse.
  GraphSolveResult solve(const GraphSolveOptions& options = {});

  /// The same, from a start as initialise_from_edges() gives it, with only those edges with a kernel whose
  /// chi2 is at most `most_chi2`; they are chosen anew after each solution until the choice stays, or ten
  /// times, at first up to 16 times as much, as a start is no solution yet. The others stay in the graph,
  /// without a say; what the result says is of the last solution. Faster than solve() by far where many edges
  /// are false: each joins far parts of the equations. Throws UsageError where `most_chi2` is not positive.
  GraphSolveResult solve_without_contradicted(double most_chi2, const GraphSolveOptions& options = {});

 private:
  friend class GraphSystem;
  friend class GraphStart;
  static constexpr int kWorld = -1;  ///< its pose is the identity
  struct Vertex {
    Pose pose;
    bool fixed = false;
  };
  struct Edge {
    RelativePose measured;
    RobustKernel kernel;
  };
  const Vertex& vertex_at(int vertex) const;
  const Edge& edge_at(int edge) const;
  /// The pose of the vertex, of the world for kWorld.
  Pose pose_or_world(int vertex) const;
  /// The motion from the measured to the present one.
  Vector6 residual(const Edge& edge) const;
  double chi2_of(const Edge& edge) const;
  /// Which number each vertex has among the unknown ones; -1 for one that keeps its pose.
  std::vector<int> unknowns() const;

  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<Edge> priors_;  ///< edges from kWorld
};

}  // namespace surefield
