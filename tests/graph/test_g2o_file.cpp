// g2o files: their convention, and what is refused.
#include "engine/io/g2o_file.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "../support/input_files.h"
#include "engine/graph/twist.h"
#include "engine/io/files.h"
#include "made_graphs.h"

using namespace surefield;
using namespace surefield::test;

namespace {

const std::string kTwo =
    "VERTEX_SE3:QUAT 7 1 2 3 0 0 0.70710678118654757 0.70710678118654757\n"
    "VERTEX_SE3:QUAT -3 1 4 3 0 0 0 1\n";
const std::string kInformation = " 1 .1 .2 .3 .4 .5 2 .6 .7 .8 .9 3 .1 .2 .3 4 .4 .5 5 .6 6";
const std::string kEdge =
    "EDGE_SE3:QUAT 7 -3 2 0 0 0 0 -0.70710678118654757 0.70710678118654757" + kInformation;

std::string error_of(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.g2o", content);
  return input_error([&] { read_g2o(file); });
}

}  // namespace

TEST_CASE("vertices are camera to world, edges from the second camera to the first") {
  const TemporaryFolder folder;
  const G2oGraph graph = read_g2o(folder.write("a.g2o", "# a comment\n" + kEdge + "\nFIX -3\r\n" + kTwo));
  REQUIRE(graph.vertices.size() == 2);
  CHECK(graph.vertices[0].id == 7);
  CHECK(graph.vertices[1].id == -3);
  CHECK_FALSE(graph.vertices[0].fixed);
  CHECK(graph.vertices[1].fixed);
  // The first stands at (1, 2, 3) and is turned by 90 degrees about z: what is ahead along its x is along the
  // world's y.
  CHECK((graph.vertices[0].pose * Eigen::Vector3d(1, 3, 3) - Eigen::Vector3d(1, 0, 0)).norm() < 1e-15);
  REQUIRE(graph.edges.size() == 1);
  const RelativePose& edge = graph.edges[0];
  CHECK(edge.from == 0);
  CHECK(edge.to == 1);
  // It measures what the vertices say.
  CHECK(motion_between(edge.pose, graph.vertices[1].pose * graph.vertices[0].pose.inverse()).norm() < 1e-14);
  CHECK(edge.information(0, 1) == 0.1);
  CHECK(edge.information(1, 0) == 0.1);
  CHECK(edge.information(2, 3) == 0.1);
  CHECK(edge.information(5, 4) == 0.6);
  CHECK(edge.information(5, 5) == 6);
}

TEST_CASE("the cost of an edge is that of g2o's error with the file's information") {
  const TemporaryFolder folder;
  G2oGraph graph = read_g2o(folder.write("a.g2o", kTwo + kEdge));
  Vector6 d;
  d << 1e-5, -2e-5, 3e-5, 2e-5, 1e-5, -1e-5;
  const Pose present = moved(graph.vertices[1].pose, d);
  PoseGraph own;
  own.add_vertex(graph.vertices[0].pose);
  own.add_vertex(present);
  own.add_edge(graph.edges[0]);
  // M^-1 X_i^-1 X_j, its translation and the vector of its rotation.
  const Pose error = graph.edges[0].pose * graph.vertices[0].pose * present.inverse();
  Vector6 e;
  e << error.translation(), rotation_vector(error.linear());
  CHECK(own.chi2(0) == doctest::Approx(e.dot(graph.edges[0].information * e)).epsilon(1e-4));
}

TEST_CASE("what is written is read back") {
  const MadeGraph made = made_torus(4, 6, {0.1, 0.2});
  G2oGraph graph;
  for (std::size_t i = 0; i < made.truth.size(); ++i)
    graph.vertices.push_back({static_cast<std::int64_t>(10 * i), made.truth[i], i == 2});
  graph.edges = made.edges;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) graph.edges[0].information(i, j) += 1.0 / (1 + i + j);
  const TemporaryFolder folder;
  write_g2o(folder / "a.g2o", graph);
  const G2oGraph read = read_g2o(folder / "a.g2o");
  REQUIRE(read.vertices.size() == graph.vertices.size());
  REQUIRE(read.edges.size() == graph.edges.size());
  for (std::size_t i = 0; i < read.vertices.size(); ++i) {
    CHECK(read.vertices[i].id == graph.vertices[i].id);
    CHECK(read.vertices[i].fixed == (i == 2));
    CHECK(motion_between(read.vertices[i].pose, graph.vertices[i].pose).norm() < 1e-13);
  }
  for (std::size_t e = 0; e < read.edges.size(); ++e) {
    CHECK(read.edges[e].from == graph.edges[e].from);
    CHECK(read.edges[e].to == graph.edges[e].to);
    CHECK(motion_between(read.edges[e].pose, graph.edges[e].pose).norm() < 1e-13);
    CHECK(read.edges[e].information == graph.edges[e].information);
  }
}

TEST_CASE("the published graphs are read whole") {
  const auto file = published_graph("sphere2500");
  if (file.empty()) return;
  const G2oGraph graph = read_g2o(file);
  CHECK(graph.vertices.size() == 2500);
  CHECK(graph.edges.size() == 4949);
  CHECK(graph.edges[0].information(3, 3) == 400.021);
}

TEST_CASE("what is wrong in a file is named with its line") {
  CHECK(contains(error_of(kTwo + "EDGE_SE3:QUAT 7 8 2 0 0 0 0 0 1" + kInformation),
                 "a.g2o:3: the file has no vertex 8"));
  CHECK(contains(error_of(kTwo + "FIX 1\n"), "a.g2o:3: the file has no vertex 1"));
  CHECK(contains(error_of(kTwo + "FIX 7.5\n"), "a.g2o:3: 7.5 is no number of a vertex"));
  CHECK(contains(error_of(kTwo + kTwo), "a.g2o:3: vertex 7 stands in the file twice"));
  CHECK(contains(error_of(kTwo + "EDGE_SE3:QUAT 7 7 2 0 0 0 0 0 1" + kInformation),
                 ":3: the edge joins a vertex to itself"));
  CHECK(
      contains(error_of("VERTEX_SE3:QUAT 1 0 0 0 0 0 0\n"), "a.g2o:1: VERTEX_SE3:QUAT has 7 numbers, not 8"));
  CHECK(contains(error_of(kTwo + kEdge + " 1"), "a.g2o:3: EDGE_SE3:QUAT has 31 numbers, not 30"));
  CHECK(contains(error_of("VERTEX_SE3:QUAT 1 0 0 x 0 0 0 1\n"),
                 "a.g2o:1: something behind VERTEX_SE3:QUAT is no number"));
  CHECK(contains(error_of("VERTEX_SE3:QUAT 1 0 0 nan 0 0 0 1\n"), "a.g2o:1: the pose is not finite"));
  CHECK(contains(error_of("VERTEX_SE3:QUAT 1 0 0 0 0 0 0 0\n"), "a.g2o:1: the quaternion"));
  CHECK(contains(error_of("VERTEX_SE2 1 0 0 0\n"), "a.g2o:1: \"VERTEX_SE2\" is not read"));
  CHECK(contains(error_of("PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n"), "is it a g2o file?"));
  CHECK(contains(error_of(""), "is it a g2o file?"));
  std::string negative = kEdge;
  negative.replace(negative.rfind('6'), 1, "-6");
  CHECK(contains(error_of(kTwo + negative), "a.g2o:3: the information matrix has a negative eigenvalue"));
  negative.replace(negative.rfind("-6"), 2, "inf");
  CHECK(contains(error_of(kTwo + negative), "a.g2o:3: the information matrix is not finite"));
  CHECK(contains(input_error([] { read_g2o("no_such.g2o"); }), "no_such.g2o"));
}
