// The pose graph: its derivatives, optima that are known, and graphs of every size.
#include "engine/graph/pose_graph.h"

#include <doctest/doctest.h>

#include <cmath>

#include "../support/input_files.h"
#include "engine/graph/twist.h"
#include "made_graphs.h"

using namespace surefield;
using namespace surefield::test;
using Eigen::Vector3d;

namespace {

Vector6 twist(double a, double b, double c, double d, double e, double f) {
  return (Vector6() << a, b, c, d, e, f).finished();
}

const Pose kFrom = moved(Pose::Identity(), twist(1, -2, 0.5, 0.7, -0.4, 1.1));
const Pose kTo = moved(Pose::Identity(), twist(-0.5, 1, 3, -0.9, 0.2, 0.6));

/// An information matrix with everything in it.
Matrix6 full_information() {
  Matrix6 root;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) root(i, j) = std::sin(3 * i + 7 * j + 1) + (i == j ? 3 : 0);
  return root.transpose() * root;
}

double distance(const Pose& a, const Pose& b) {
  return motion_between(a, b).norm();
}

RobustKernel cauchy(double scale) {
  return {RobustKernel::Kind::Cauchy, scale};
}

}  // namespace

TEST_CASE("rotation vectors come back, from none to half a turn") {
  const Vector3d axis = Vector3d(0.3, -0.8, 0.5).normalized();
  for (const double angle : {0.0, 1e-12, 1e-7, 5e-5, 2e-4, 0.01, 1.0, 3.0, 3.14159, 3.1415926}) {
    const Eigen::Matrix3d rotation = rotation_of(angle * axis);
    CHECK((rotation * rotation.transpose()).isIdentity(1e-14));
    CHECK((rotation - Eigen::AngleAxisd(angle, axis).toRotationMatrix()).norm() < 1e-14);
    CHECK((rotation_vector(rotation) - angle * axis).norm() < 1e-13);
  }
  CHECK(rotation_vector(Eigen::AngleAxisd(4, axis).toRotationMatrix()).norm() < std::acos(-1.0));
}

TEST_CASE("the motion between two poses moves one to the other") {
  CHECK(distance(moved(kFrom, motion_between(kFrom, kTo)), kTo) < 1e-14);
  const Vector6 d = twist(0.1, 0.2, 0.3, 0.4, -0.5, 0.6);
  CHECK((motion_between(kFrom, moved(kFrom, d)) - d).norm() < 1e-14);
}

TEST_CASE("an edge's derivatives are those of finite differences, however far it is from what it measures") {
  for (const double size : {0.0, 1e-6, 0.02, 0.3, 1.0, 2.9}) {
    const Pose present = kTo * kFrom.inverse();
    const Vector6 off = size / std::sqrt(3.0) * twist(0.5, -0.4, 2, 1, -1, 1);
    const Pose measured = moved(present, off);
    const Vector6 r = motion_between(measured, present);
    const Matrix6 by_to = motion_jacobian(r), by_from = -by_to * adjoint(present);
    const double step = 1e-6;
    for (int i = 0; i < 6; ++i) {
      const Vector6 d = step * Vector6::Unit(i);
      const auto residual = [&](const Pose& from, const Pose& to) {
        return motion_between(measured, to * from.inverse());
      };
      const Vector6 to = (residual(kFrom, moved(kTo, d)) - residual(kFrom, moved(kTo, -d))) / (2 * step);
      const Vector6 from = (residual(moved(kFrom, d), kTo) - residual(moved(kFrom, -d), kTo)) / (2 * step);
      INFO(size, " ", i);
      CHECK((to - by_to.col(i)).norm() < 1e-7);
      CHECK((from - by_from.col(i)).norm() < 1e-7);
    }
  }
}

TEST_CASE("at what it measures an edge's derivatives are the identity and -Ad(Z)") {
  CHECK((motion_jacobian(Vector6::Zero()) - Matrix6::Identity()).norm() == 0);
  const Eigen::Matrix3d r = kTo.linear();
  Matrix6 ad = Matrix6::Zero();
  ad << r, cross_matrix(kTo.translation()) * r, Eigen::Matrix3d::Zero(), r;
  CHECK((adjoint(kTo) - ad).norm() == 0);
}

TEST_CASE("the weight of a kernel is the derivative of its cost, which grows ever more slowly") {
  for (const auto kind :
       {RobustKernel::Kind::None, RobustKernel::Kind::Cauchy, RobustKernel::Kind::DynamicCovariance}) {
    const RobustKernel kernel{kind, 1.5};
    CHECK(kernel.cost(0) == 0);
    for (const double chi2 : {0.1, 1.0, 2.2, 2.3, 10.0, 1000.0}) {
      const double step = 1e-5 * chi2;
      const double slope = (kernel.cost(chi2 + step) - kernel.cost(chi2 - step)) / (2 * step);
      CHECK(slope == doctest::Approx(kernel.weight(chi2)).epsilon(1e-6));
      CHECK(kernel.weight(2 * chi2) <= kernel.weight(chi2));
    }
    CHECK((kernel.weight(1e6) < 1e-3) == (kind != RobustKernel::Kind::None));
  }
}

TEST_CASE("normal equations of a pair become the measurement that they have their minimum at") {
  const Matrix6 h = full_information();
  const Vector6 there = twist(0.01, -0.02, 0.005, 0.003, 0.01, -0.004);
  const RelativePose edge = relative_pose_of(3, 5, kTo, h, -h * there);
  CHECK(edge.from == 3);
  CHECK(edge.to == 5);
  CHECK((motion_between(kTo, edge.pose) - there).norm() < 1e-12);
  CHECK((edge.information - h).norm() < 1e-12 * h.norm());
}

TEST_CASE("a direction that normal equations leave open is not measured and not moved along") {
  Matrix6 h = full_information();
  h.row(1).setZero();
  h.col(1).setZero();
  const Vector6 there = twist(0.01, 0, 0.005, 0.003, 0.01, -0.004);
  const RelativePose edge = relative_pose_of(0, 1, kTo, h, -h * there);
  CHECK((motion_between(kTo, edge.pose) - there).norm() < 1e-9);
  CHECK(edge.information.row(1).norm() < 1e-9);
  const RelativePose nothing = relative_pose_of(0, 1, kTo, Matrix6::Zero(), Vector6::Zero());
  CHECK(nothing.information.norm() == 0);
  CHECK(distance(nothing.pose, kTo) < 1e-15);
}

TEST_CASE("two poses: the free one goes where the edge says, from anywhere") {
  for (const double wrong : {0.0, 0.1, 3.0}) {
    PoseGraph graph;
    graph.add_vertex(kFrom, true);
    graph.add_vertex(moved(kTo, wrong / 2 * twist(5, 2, -3, 1, 0.2, -0.8)));
    graph.add_edge({0, 1, kTo * kFrom.inverse(), full_information()});
    const GraphSolveResult result = graph.solve();
    CHECK(result.converged);
    CHECK(result.final_cost < 1e-18);
    CHECK(distance(graph.pose(1), kTo) < 1e-10);
    CHECK(graph.pose(0).matrix() == kFrom.matrix());
  }
}

TEST_CASE("edges and priors that disagree meet at their weighted mean") {
  const Matrix6 information = full_information();
  const auto at = [&](const Vector6& d) { return moved(kTo, 1e-4 * d); };
  const Vector6 a = twist(1, 2, 3, 0, 0, 0), b = twist(-1, 0, 2, 0, 0, 0), c = twist(4, -3, 0, 0, 0, 0);
  PoseGraph graph;
  graph.add_vertex(kFrom, true);
  graph.add_vertex(kTo);
  graph.add_edge({0, 1, at(a) * kFrom.inverse(), information});
  graph.add_edge({1, 0, kFrom * at(b).inverse(), Matrix6::Identity()});
  graph.add_prior(1, at(c), 3 * Matrix6::Identity());
  REQUIRE(graph.solve().converged);
  // The edge on the way back measures in the camera 0.
  const Matrix6 back = adjoint(kFrom * kTo.inverse());
  const Matrix6 second = back.transpose() * back;
  const Matrix6 sum = information + second + 3 * Matrix6::Identity();
  const Vector6 mean = sum.ldlt().solve(information * a + second * b + 3 * c);
  CHECK((motion_between(kTo, graph.pose(1)) - 1e-4 * mean).norm() < 1e-7);
}

TEST_CASE("graphs of no pose, of one, and of poses that nothing joins are solved and stay") {
  PoseGraph graph;
  CHECK(graph.solve().converged);
  graph.initialise_from_edges();
  graph.add_vertex(kFrom);
  CHECK(graph.solve().converged);
  graph.add_vertex(kTo);
  graph.add_vertex(kFrom, true);
  graph.initialise_from_edges();
  const GraphSolveResult result = graph.solve();
  CHECK(result.converged);
  CHECK(result.final_cost == 0);
  CHECK(graph.pose(0).matrix() == kFrom.matrix());
  CHECK(graph.pose(1).matrix() == kTo.matrix());
}

TEST_CASE("of a part without a fixed pose the first is held; a prior holds a part too") {
  PoseGraph graph;
  for (int i = 0; i < 4; ++i) graph.add_vertex(i % 2 ? kTo : kFrom);
  graph.add_edge({1, 2, Pose::Identity(), full_information()});
  graph.add_edge({3, 0, Pose::Identity(), full_information()});
  graph.add_prior(0, kTo, Matrix6::Identity());
  CHECK(graph.solve().converged);
  CHECK(graph.pose(1).matrix() == kTo.matrix());
  for (const int i : {0, 2, 3}) CHECK(distance(graph.pose(i), kTo) < 1e-8);
}

TEST_CASE("edges without weight move nothing, directions without weight stay bounded") {
  PoseGraph graph;
  graph.add_vertex(kFrom, true);
  graph.add_vertex(kTo);
  graph.add_vertex(kTo);
  graph.add_edge({0, 1, Pose::Identity(), Matrix6::Zero()});
  Matrix6 along_x = Matrix6::Zero();
  along_x(0, 0) = 100;
  graph.add_edge({1, 2, moved(Pose::Identity(), twist(0.5, 0, 0, 0, 0, 0)), along_x});
  const GraphSolveResult result = graph.solve();
  CHECK(result.final_cost < 1e-12);
  CHECK(distance(graph.pose(1), kTo) < 1);
  graph.initialise_from_edges();
  CHECK(distance(graph.pose(2), kTo) < 2);
}

TEST_CASE("a loop without noise closes to the truth") {
  const MadeGraph made = made_sphere(5, 12, {});
  PoseGraph graph = from_odometry(made);
  for (int i = 1; i < graph.vertices(); ++i)
    graph.set_pose(i, moved(graph.pose(i), 0.002 * i * twist(1, 0, 2, 0, 1, 1)));
  const GraphSolveResult result = graph.solve();
  CHECK(result.converged);
  CHECK(result.initial_cost > 1);
  CHECK(result.final_cost < 1e-12);
  CHECK(result.final_cost == graph.cost());
  CHECK(furthest_off(graph, made.truth) < 1e-8);
}

TEST_CASE("a false loop stands out by its chi2 and, with a kernel, draws nothing") {
  MadeGraph made = made_sphere(5, 12, {0.002, 0.002});
  PoseGraph without = from_odometry(made);
  without.solve();
  const Vector6 error = twist(0.5, 0, 0.3, 0.1, 0, 0);
  const int from = 3, to = 40;
  made.edges.push_back(
      {from, to, moved(made.truth[to] * made.truth[from].inverse(), error), made.edges.front().information});
  const double usual = furthest_off(without, made.truth);
  for (const RobustKernel& kernel : {cauchy(3), RobustKernel{RobustKernel::Kind::DynamicCovariance, 4}}) {
    PoseGraph graph = from_odometry(made, kernel);
    CHECK(graph.solve().converged);
    CHECK(furthest_off(graph, made.truth) < 1.5 * usual);
    CHECK(graph.chi2(graph.edges() - 1) > 1000);
    CHECK(kernel.weight(graph.chi2(graph.edges() - 1)) < 0.01);
  }
  PoseGraph graph = from_odometry(made, cauchy(3));
  graph.initialise_from_edges();
  CHECK(graph.solve_without_contradicted(16.8).converged);
  CHECK(graph.edges() == static_cast<int>(made.edges.size()));
  CHECK(furthest_off(graph, made.truth) < 1.5 * usual);
  CHECK_THROWS_AS(graph.solve_without_contradicted(0), UsageError);
  PoseGraph plain = from_odometry(made);
  plain.solve();
  CHECK(furthest_off(plain, made.truth) > 3 * usual);
  plain.remove_edge(plain.edges() - 1);
  plain.solve();
  CHECK(furthest_off(plain, made.truth) == doctest::Approx(usual).epsilon(1e-3));
}

TEST_CASE("the poses of a graph do not depend on where the world's origin is") {
  const MadeGraph made = made_sphere(4, 10, {0.01, 0.01});
  MadeGraph elsewhere = made;
  for (Pose& pose : elsewhere.truth) pose = pose * kTo;
  PoseGraph here = from_odometry(made), there = from_odometry(elsewhere);
  CHECK(here.solve().final_cost == doctest::Approx(there.solve().final_cost).epsilon(1e-9));
  for (int i = 0; i < here.vertices(); ++i) CHECK(distance(here.pose(i) * kTo, there.pose(i)) < 1e-6);
}

TEST_CASE("calls with what is not there are refused, and nothing has changed") {
  PoseGraph graph;
  graph.add_vertex(kFrom);
  graph.add_vertex(kTo);
  Pose broken = kTo;
  broken.translation().x() = std::nan("");
  CHECK_THROWS_AS(graph.add_vertex(broken), UsageError);
  CHECK_THROWS_AS(graph.set_pose(0, broken), UsageError);
  CHECK_THROWS_AS(graph.set_pose(2, kTo), UsageError);
  CHECK_THROWS_AS(graph.set_fixed(-1, true), UsageError);
  CHECK_THROWS_AS(graph.add_edge({0, 2, kTo, Matrix6::Identity()}), UsageError);
  CHECK_THROWS_AS(graph.add_edge({1, 1, kTo, Matrix6::Identity()}), UsageError);
  CHECK_THROWS_AS(graph.add_edge({0, 1, broken, Matrix6::Identity()}), UsageError);
  CHECK_THROWS_AS(graph.add_edge({0, 1, kTo, Matrix6::Identity() * std::nan("")}), UsageError);
  CHECK_THROWS_AS(graph.add_edge({0, 1, kTo, Matrix6::Identity()}, cauchy(0)), UsageError);
  CHECK_THROWS_AS(graph.add_prior(2, kTo, Matrix6::Identity()), UsageError);
  CHECK_THROWS_AS(graph.remove_edge(0), UsageError);
  CHECK_THROWS_AS(graph.chi2(0), UsageError);
  CHECK(graph.vertices() == 2);
  CHECK(graph.edges() == 0);
}
