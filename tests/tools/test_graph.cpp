// surefield graph: a run's graph as g2o, and a g2o file optimised.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/io/files.h"
#include "engine/io/g2o_file.h"
#include "engine/io/trajectory_file.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// A square of four poses with a side of 1 m, turned by 90 degrees at each corner, whose last one is off;
/// the edges say the square.
G2oGraph square() {
  G2oGraph graph;
  Pose step = Pose::Identity();
  step.linear() = Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
  step.translation() = Eigen::Vector3d(0, 0, -1);
  Pose pose = Pose::Identity();
  for (int i = 0; i < 4; ++i) {
    graph.vertices.push_back({i, pose, false});
    if (i < 3) graph.edges.push_back({i, i + 1, step, 1e4 * Matrix6::Identity()});
    pose = step * pose;
  }
  graph.edges.push_back({3, 0, step, 1e4 * Matrix6::Identity()});
  graph.edges.push_back({0, 2, step * step, 1e4 * Matrix6::Identity()});
  graph.vertices[3].pose.translation() += Eigen::Vector3d(0.2, 0.1, -0.1);
  return graph;
}

double off(const G2oGraph& a, const G2oGraph& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    most = std::max(most, (a.vertices[i].pose.matrix() - b.vertices[i].pose.matrix()).norm());
  return most;
}

G2oGraph true_square() {
  G2oGraph graph = square();
  graph.vertices[3].pose = graph.edges[2].pose * graph.vertices[2].pose;
  return graph;
}

}  // namespace

TEST_CASE("graph moves a g2o file's vertices to where its edges want them and says the costs") {
  const TemporaryFolder folder;
  write_g2o(folder / "in.g2o", square());
  const Outcome outcome =
      surefield_command({"graph", folder / "in.g2o", "--out", folder / "out.g2o"}, folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "4 vertices, 5 edges: cost 600 in the file"));
  CHECK(contains(outcome.out, "0 edges are off"));
  CHECK(off(read_g2o(folder / "out.g2o"), true_square()) < 1e-9);
}

TEST_CASE("graph --robust leaves false loops aside, and they are counted") {
  const TemporaryFolder folder;
  G2oGraph graph = square();
  graph.edges.back().pose.translation() += Eigen::Vector3d(0.5, 0, 0);
  write_g2o(folder / "in.g2o", graph);
  const auto solve = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"graph", folder / "in.g2o", "--out", folder / "out.g2o"});
    const Outcome outcome = surefield_command(more, folder.path());
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    return std::pair(outcome.out, off(read_g2o(folder / "out.g2o"), true_square()));
  };
  CHECK(solve({}).second > 0.05);
  const auto [out, left] = solve({"--robust", "3"});
  CHECK(left < 0.05);
  CHECK(contains(out, "1 edges are off"));
}

TEST_CASE("graph writes the keyframes of a run with an edge from each to the next") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "run", 12), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const Outcome outcome =
      surefield_command({"graph", folder / "run", "--out", folder / "run.g2o"}, folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  const G2oGraph graph = read_g2o(folder / "run.g2o");
  const Trajectory keyframes = read_trajectory(folder / "run" / "keyframes.txt");
  REQUIRE(graph.vertices.size() == keyframes.size());
  CHECK(keyframes.size() > 1);
  CHECK(graph.edges.size() == keyframes.size() - 1);
  CHECK(graph.vertices[0].fixed);
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    CHECK((graph.vertices[k].pose * keyframes[k].camera_to_world).isApprox(Pose::Identity(), 1e-9));
  // Its edges are what the vertices say: nothing is left to do.
  const Outcome solved =
      surefield_command({"graph", folder / "run.g2o", "--out", folder / "solved.g2o"}, folder.path());
  CHECK_MESSAGE(solved.code == 0, solved.err);
  CHECK(off(read_g2o(folder / "solved.g2o"), graph) < 1e-9);
  const Outcome refused = surefield_command(
      {"graph", folder / "run", "--out", folder / "run.g2o", "--robust", "3"}, folder.path());
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "--robust is for g2o files"));
}

TEST_CASE("graph adds a run's accepted loops as edges with their information") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "run", 12), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  forget_files(folder / "run");
  const auto metrics = nlohmann::json::parse(read_file(folder / "run/metrics.json"));
  std::vector<int> keyframes;
  for (const auto& frame : metrics["per_frame"])
    if (frame["keyframe"] == true) keyframes.push_back(frame["index"]);
  REQUIRE(keyframes.size() > 1);
  const auto graph_with = [&](const std::string& names, const std::string& values) {
    std::ofstream(folder / "run/loops.csv") << names << "\n" << values;
    return surefield_command({"graph", folder / "run", "--out", folder / "run.g2o"}, folder.path());
  };
  const std::string names = "from,to,why,accepted,tx,ty,tz,qx,qy,qz,qw,information";
  const std::string information = "11 12 13 14 15 16 22 23 24 25 26 33 34 35 36 44 45 46 55 56 66";
  const std::string ends = fmt::format("{},{}", keyframes.back(), keyframes.front());
  const Outcome outcome = graph_with(names, ends + ",few matches,0,0,0,0,0,0,0,1,\n" + ends +
                                                ",agreed,1,0.5,-0.25,2,0,0.6,0,0.8," + information + "\n");
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "1 of them loops"));
  const G2oGraph graph = read_g2o(folder / "run.g2o");
  REQUIRE(graph.edges.size() == keyframes.size());
  const RelativePose& loop = graph.edges.back();
  CHECK(loop.from == static_cast<int>(keyframes.size()) - 1);
  CHECK(loop.to == 0);
  CHECK((loop.pose.translation() - Eigen::Vector3d(0.5, -0.25, 2)).norm() < 1e-9);
  CHECK(Eigen::Quaterniond(loop.pose.linear()).angularDistance(Eigen::Quaterniond(0.8, 0, 0.6, 0)) < 1e-9);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) {
      const int number = 11 + 10 * std::min(row, column) + std::max(row, column);
      CHECK(loop.information(row, column) == doctest::Approx(number));
    }
  const auto refusal = [&](const std::string& values) {
    const Outcome refused = graph_with(names, values);
    CHECK(refused.code == 2);
    return refused.err;
  };
  CHECK(contains(refusal(ends + ",agreed,1,0,0,0,0,0,0,1,1 2 3\n"), "loops.csv:2: has no 21 numbers"));
  CHECK(contains(refusal("0,777,agreed,1,0,0,0,0,0,0,1," + information + "\n"), "frame 777 is no keyframe"));
  const Outcome bare = graph_with("from,to,accepted,tx,ty,tz,qx,qy,qz,qw", ends + ",1,0,0,0,0,0,0,1\n");
  CHECK(bare.code == 2);
  CHECK(contains(bare.err, "has no information"));
}

TEST_CASE("graph names what is wrong with a file") {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& input) {
    const Outcome outcome = surefield_command({"graph", input, "--out", folder / "out.g2o"}, folder.path());
    CHECK(outcome.code == 2);
    CHECK_FALSE(file_exists(folder / "out.g2o"));
    return outcome.err;
  };
  CHECK(contains(refusal(folder / "none.g2o"), "none.g2o"));
  CHECK(contains(refusal(folder.write("bad.g2o", "VERTEX_SE2 0 0 0 0\n")), "bad.g2o:1: "));
  CHECK(contains(refusal(folder.path()), "is this a folder that surefield run has written?"));
}
