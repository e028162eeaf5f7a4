// surefield graph: a run's keyframe graph as a g2o file, and the poses that a g2o file's edges want.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "engine/graph/pose_graph.h"
#include "engine/io/files.h"
#include "engine/types/error.h"
#include "tools/export/run_graph.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr const char* kGraphExamples =
    "A folder of results becomes a g2o file of its keyframes, with an edge from each to the next "
    "and\n"
    "one for each loop that it accepted (docs/graph.md).\n"
    "A g2o file (VERTEX_SE3:QUAT, EDGE_SE3:QUAT, FIX) of whatever program is optimised: it starts from the "
    "poses\n"
    "in the file or from those that linear equations give, whichever cost less. Without FIX the first vertex "
    "of\n"
    "each part that edges join stays where it is.\n"
    "\n"
    "Examples:\n"
    "  surefield graph out/desk --out desk.g2o\n"
    "  surefield graph sphere2500.g2o --out sphere_solved.g2o\n"
    "  surefield graph with_false_loops.g2o --robust 3 --out solved.g2o\n";

constexpr double kRareChi2 = 16.8;  // six numbers exceed it in 1 of 100 cases

struct GraphOptions {
  std::string input;  ///< folder of results or g2o file
  std::string out;
  double robust = 0;  ///< scale of the loops' kernel; 0: none
};

int export_graph(const GraphOptions& options) {
  const G2oGraph graph = graph_of_run(read_run(options.input));
  write_g2o(options.out, graph);
  fmt::print("{} keyframes, {} edges, {} of them loops: {}\n", graph.vertices.size(), graph.edges.size(),
             graph.edges.size() - (graph.vertices.size() - 1), options.out);
  return kSuccess;
}

/// The pose graph of a file. Edges between neighbours in the file's order are odometry: they are believed.
PoseGraph pose_graph_of(const G2oGraph& file, double robust) {
  PoseGraph graph;
  for (const G2oGraph::Vertex& vertex : file.vertices) graph.add_vertex(vertex.pose, vertex.fixed);
  for (const RelativePose& edge : file.edges) {
    const bool is_loop = std::abs(edge.to - edge.from) != 1;
    graph.add_edge(edge,
                   robust > 0 && is_loop ? RobustKernel{RobustKernel::Kind::Cauchy, robust} : RobustKernel{});
  }
  return graph;
}

int edges_off(const PoseGraph& graph) {
  int count = 0;
  for (int e = 0; e < graph.edges(); ++e) count += graph.chi2(e) > kRareChi2;
  return count;
}

int optimise_graph(const GraphOptions& options) {
  G2oGraph file = read_g2o(options.input);
  PoseGraph graph = pose_graph_of(file, options.robust);
  const double cost_in_file = graph.cost();
  const auto begin = std::chrono::steady_clock::now();
  PoseGraph linear = graph;
  linear.initialise_from_edges();
  const bool starts_linear = linear.cost() < cost_in_file;
  if (starts_linear) graph = std::move(linear);
  const GraphSolveResult result =
      options.robust > 0 ? graph.solve_without_contradicted(kRareChi2) : graph.solve();
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  for (int i = 0; i < graph.vertices(); ++i) file.vertices[i].pose = graph.pose(i);
  write_g2o(options.out, file);
  fmt::print("{} vertices, {} edges: cost {:.6g} in the file", graph.vertices(), graph.edges(), cost_in_file);
  if (starts_linear) fmt::print(", {:.6g} at the linear start", result.initial_cost);
  fmt::print(", {:.6g} now; {} iterations, {:.2f} s\n", result.final_cost, result.iterations, time.count());
  fmt::print("{} edges are off by more than 1 of 100 should be (chi2 above {})\n", edges_off(graph),
             kRareChi2);
  fmt::print("-> {}\n", options.out);
  if (result.converged) return kSuccess;
  fmt::print(stderr, "surefield: note: not converged after {} iterations; run it again on {}\n",
             result.iterations, options.out);
  return kDoubtful;
}

}  // namespace

void add_graph(CLI::App& program, Action& action) {
  auto options = std::make_shared<GraphOptions>();
  CLI::App* command =
      program.add_subcommand("graph", "Writes a run's keyframe graph as g2o, or optimises a g2o file");
  command->add_option("input", options->input, "Folder of results of surefield run, or g2o file")->required();
  command->add_option("--out", options->out, "g2o file to write")->required();
  command
      ->add_option(
          "--robust", options->robust,
          "Of a g2o file: edges that do not join neighbours in its order may be false; they lose weight "
          "beyond so many standard deviations")
      ->check(CLI::PositiveNumber);
  command->footer(kGraphExamples);
  command->callback([options, &action] {
    action = [options] {
      if (!folder_exists(options->input)) return optimise_graph(*options);
      if (options->robust > 0) throw InputError("--robust is for g2o files; export the run first");
      return export_graph(*options);
    };
  });
}

}  // namespace surefield
