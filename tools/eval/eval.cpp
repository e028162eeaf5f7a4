// surefield eval: how far a run, or any trajectory, is from the truth.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
#include "tools/eval/eval_mesh.h"
#include "tools/eval/eval_run.h"
#include "tools/results/trajectory_report.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr const char* kEvalExamples =
    "With --run, the results of surefield run are measured: the trajectory, and the map's images of all "
    "frames\n"
    "and of those that were no keyframes; runtime and memory are shown beside them. With --trajectory, any "
    "two\n"
    "trajectories are compared, of whatever system. With --ground-truth-mesh, a mesh (surefield mesh) or "
    "the\n"
    "centres of the Gaussians are compared with a true surface: in the dataset's frame, or in that of "
    "--run.\n"
    "Trajectories are aligned to the truth by a rigid transform (Horn, no scale); poses are paired where "
    "their\n"
    "time stamps are at most 0.02 s apart. All measures are defined in docs/evaluation.md.\n"
    "\n"
    "Examples:\n"
    "  surefield eval --run out/desk\n"
    "  surefield eval --run out/desk --dataset rgbd_dataset_freiburg1_desk --lpips alex.onnx --json "
    "errors.json\n"
    "  surefield eval --run out/office --mesh office.ply --ground-truth-mesh office/mesh.ply\n"
    "  surefield eval --trajectory CameraTrajectory.txt --ground-truth rgbd_dataset_freiburg1_desk\n"
    "  surefield eval --trajectory out/desk/keyframes.txt --ground-truth groundtruth.txt --json "
    "errors.json\n";

struct EvalOptions {
  std::string trajectory;
  std::string ground_truth;  ///< a TUM file or the folder of a dataset
  EvalRunOptions run;        ///< its json is the file that every mode writes
  EvalMeshOptions mesh;      ///< run, dataset and json are taken from `run`
};

Trajectory read_ground_truth(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return read_trajectory(path);
  Dataset dataset = open_dataset(path);
  if (!dataset.ground_truth) throw InputError(path, "this dataset has no ground truth");
  return *std::move(dataset.ground_truth);
}

int compare_trajectories(const EvalOptions& options) {
  const Trajectory estimate = read_trajectory(options.trajectory);
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, read_ground_truth(options.ground_truth));
  if (!options.run.json.empty()) {
    nlohmann::ordered_json json = {{"schema", "surefield-trajectory"}, {"version", 1}};
    json.update(trajectory_json(metrics));
    write_file(options.run.json, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
  }
  fmt::print("{}", trajectory_table(metrics));
  return kSuccess;
}

int compare_with_true_mesh(const EvalOptions& options) {
  EvalMeshOptions mesh = options.mesh;
  mesh.run = options.run.run;
  mesh.dataset = options.run.dataset;
  mesh.json = options.run.json;
  return evaluate_mesh(mesh);
}

int evaluate(const EvalOptions& options) {
  if (!options.mesh.truth.empty()) return compare_with_true_mesh(options);
  if (!options.run.run.empty()) return evaluate_run(options.run);
  if (!options.trajectory.empty()) return compare_trajectories(options);
  throw InputError(
      "nothing to measure: give --run, or --trajectory, or --ground-truth-mesh; see surefield eval "
      "--help");
}

}  // namespace

void add_eval(CLI::App& program, Action& action) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* eval =
      program.add_subcommand("eval", "Measures a run, or a trajectory, against ground truth and images");
  CLI::Option* run = eval->add_option("--run", options->run.run, "Folder of results of surefield run");
  eval->add_option("--dataset", options->run.dataset,
                   "Folder of the run's dataset, where it is no longer where it was; beside "
                   "--ground-truth-mesh also without a run");
  eval->add_option("--lpips", options->run.lpips,
                   "Network of the LPIPS distance, ONNX (docs/evaluation.md tells how to make it)")
      ->needs(run);
  eval->add_option("--device", options->run.engine.device,
                   "Number or part of the name of the device, see surefield devices; default: the best");
  CLI::Option* trajectory =
      eval->add_option("--trajectory", options->trajectory, "Trajectory in TUM format")->excludes(run);
  CLI::Option* truth = eval->add_option("--ground-truth", options->ground_truth,
                                        "True trajectory in TUM format, or the folder of a dataset");
  trajectory->needs(truth);
  truth->needs(trajectory);
  add_mesh_options(*eval, options->mesh);
  eval->add_option("--json", options->run.json, "Also writes what was measured to this file");
  eval->footer(kEvalExamples);
  eval->callback([options, &action] { action = [options] { return evaluate(*options); }; });
}

}  // namespace surefield
