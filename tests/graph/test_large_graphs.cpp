// Large graphs: the optimum that others find is found from odometry, the same to the last bit, false loops or
// not.
#include <doctest/doctest.h>

#include "../support/input_files.h"
#include "engine/graph/pose_graph.h"
#include "made_graphs.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr double kRareChi2 = 16.8;  // six numbers exceed it in 1 of 100 cases

/// The costs of a published graph's optimum (Ceres' geodesic one, from a chordal start).
struct Published {
  const char* name;
  double cost;
};

double solved_cost(PoseGraph& graph) {
  const GraphSolveResult result = graph.solve();
  CHECK(result.converged);
  return result.final_cost;
}

void check_made(const MadeGraph& made) {
  PoseGraph from_truth = from_odometry(made), graph = from_odometry(made);
  for (int i = 0; i < from_truth.vertices(); ++i) from_truth.set_pose(i, made.truth[i]);
  const double least = solved_cost(from_truth);
  graph.initialise_from_edges();
  CHECK(solved_cost(graph) <= 1.001 * least);
}

/// With 10 % false loops no vertex is off by more than twice as much as without.
void check_false_edges(MadeGraph made) {
  const RobustKernel kernel{RobustKernel::Kind::Cauchy, 3};
  const auto off = [&] {
    PoseGraph graph = from_odometry(made, kernel);
    graph.initialise_from_edges();
    CHECK(graph.solve_without_contradicted(kRareChi2).converged);
    return furthest_off(graph, made.truth);
  };
  const double without = off();
  add_false_edges(made, 0.1);
  const double with = off();
  INFO(without, " ", with);
  CHECK(with <= 2 * without);
}

void check_published(const Published& published, bool from_file) {
  const auto file = published_graph(published.name);
  if (file.empty()) return;
  PoseGraph graph = read_graph(file);
  if (!from_file) graph.initialise_from_edges();
  INFO(published.name);
  CHECK(solved_cost(graph) == doctest::Approx(published.cost).epsilon(1e-3));
}

}  // namespace

TEST_CASE("small published graphs reach their optimum, from odometry alone and from the linear start") {
  for (const Published& published : {Published{"tinyGrid3D", 9.30808}, {"smallGrid3D", 516.947}}) {
    check_published(published, true);
    check_published(published, false);
  }
}

TEST_CASE("[slow] large published graphs reach their optimum") {
  for (const Published& published :
       {Published{"sphere2500", 675.681}, {"torus3D", 12116.5}, {"parking-garage", 0.634192}})
    check_published(published, false);
}

TEST_CASE("graphs of some hundred vertices reach from odometry what they reach from the truth") {
  check_made(made_sphere(10, 30, {0.02, 0.02}));
  check_made(made_torus(10, 30, {0.02, 0.05}));
  check_made(made_grid(8, 7, 6, {0.05, 0.1}));
}

TEST_CASE("[long] graphs of thousands of vertices reach from odometry what they reach from the truth") {
  check_made(made_sphere(50, 50, {0.05, 0.1}));
  check_made(made_torus(50, 100, {0.05, 0.05}));
  check_made(made_grid(14, 14, 13, {0.1, 0.1}));
}

TEST_CASE("a tenth of false loops does not draw a graph of some hundred vertices away") {
  check_false_edges(made_sphere(10, 30, {0.01, 0.01}));
  check_false_edges(made_torus(10, 30, {0.02, 0.02}));
  check_false_edges(made_grid(8, 7, 6, {0.05, 0.05}));
}

TEST_CASE("[long] a tenth of false loops does not draw large graphs away") {
  check_false_edges(made_sphere(50, 50, {0.05, 0.1}));
  check_false_edges(made_torus(50, 100, {0.05, 0.05}));
  check_false_edges(made_grid(10, 10, 10, {0.05, 0.05}));
}

TEST_CASE("the same graph gives the same bits") {
  MadeGraph made = made_grid(6, 6, 6, {0.05, 0.1});
  add_false_edges(made, 0.1);
  PoseGraph a = from_odometry(made, {RobustKernel::Kind::Cauchy, 3}), b = a;
  for (PoseGraph* graph : {&a, &b}) {
    graph->initialise_from_edges();
    graph->solve();
  }
  for (int i = 0; i < a.vertices(); ++i) CHECK(a.pose(i).matrix() == b.pose(i).matrix());
  CHECK(a.cost() == b.cost());
}
