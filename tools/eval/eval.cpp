// surefield eval: how far a run, or any trajectory, is from the truth.
#include <memory>

#include "engine/types/error.h"
#include "tools/eval/eval_loops.h"
#include "tools/eval/eval_mesh.h"
#include "tools/eval/eval_run.h"
#include "tools/eval/eval_trajectory.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr const char* kEvalExamples =
    "With --run, the results of surefield run are measured: the trajectory, and the map's images of all "
    "frames\n"
    "and of the held-out ones, which were no keyframes; runtime and memory are shown beside them. With\n"
    "--trajectory, any two trajectories are compared, of whatever system: TUM, KITTI, EuRoC, RTAB-Map, 4 x "
    "4\n"
    "matrices, Bundler, transforms.json, told by the content. Poses without stamps belong to the frames of "
    "the\n"
    "dataset, or to the true poses, where they are as many. With --ground-truth-mesh, a mesh (surefield "
    "mesh) "
    "or\n"
    "the centres of the Gaussians are compared with a true surface: in the dataset's frame, or in that of "
    "--run.\n"
    "With --loops, the loops that a run accepted are compared with what its keyframes truly see again.\n"
    "Trajectories are aligned to the truth by a rigid transform (--align se3; sim3 adds a scale); poses are\n"
    "paired where their time stamps are at most 0.02 s apart. All measures are defined in "
    "docs/evaluation.md.\n"
    "\n"
    "Examples:\n"
    "  surefield eval --run out/desk\n"
    "  surefield eval --run out/desk --dataset rgbd_dataset_freiburg1_desk --lpips alex.onnx --json "
    "errors.json\n"
    "  surefield eval --run out/office --scale 1\n"
    "  surefield eval --run out/office --mesh office.ply --ground-truth-mesh office/mesh.ply\n"
    "  surefield eval --loops out/walk --json loops.json\n"
    "  surefield eval --trajectory CameraTrajectory.txt --ground-truth rgbd_dataset_freiburg1_desk\n"
    "  surefield eval --trajectory monocular.csv --ground-truth groundtruth.txt --align sim3 --json "
    "errors.json\n";

struct EvalOptions {
  TrajectoryEvaluation trajectory;  ///< its json is taken from `run`
  EvalRunOptions run;               ///< its json is the file that every mode writes
  EvalMeshOptions mesh;             ///< run, dataset and json are taken from `run`
  EvalLoopsOptions loops;           ///< dataset and json are taken from `run`
};

int compare_trajectories(const EvalOptions& options) {
  TrajectoryEvaluation evaluation = options.trajectory;
  evaluation.json = options.run.json;
  return evaluate_trajectories(evaluation);
}

int compare_with_true_mesh(const EvalOptions& options) {
  EvalMeshOptions mesh = options.mesh;
  mesh.run = options.run.run;
  mesh.dataset = options.run.dataset;
  mesh.json = options.run.json;
  return evaluate_mesh(mesh);
}

int judge_loops(const EvalOptions& options) {
  EvalLoopsOptions loops = options.loops;
  loops.dataset = options.run.dataset;
  loops.json = options.run.json;
  return evaluate_loops(loops);
}

int evaluate(const EvalOptions& options) {
  if (!options.loops.run.empty()) return judge_loops(options);
  if (!options.mesh.truth.empty()) return compare_with_true_mesh(options);
  if (!options.run.run.empty()) return evaluate_run(options.run);
  if (!options.trajectory.estimate.empty()) return compare_trajectories(options);
  throw InputError(
      "nothing to measure: give --run, --trajectory, --loops, or --ground-truth-mesh; see surefield eval "
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
  eval->add_option(
          "--views", options->run.views,
          "A dataset whose true poses are in the same world as those of the run's: the map is compared "
          "with all of its images too, as with those that surefield synth --beside writes")
      ->needs(run);
  eval->add_option("--scale", options->run.scale,
                   "Size of the images that the map is compared with, relative to the originals; default: "
                   "that of the run")
      ->check(CLI::Range(0.01, 1.0))
      ->default_str("")
      ->needs(run);
  eval->add_option("--lpips", options->run.lpips,
                   "Network of the LPIPS distance, ONNX (docs/evaluation.md tells how to make it)")
      ->needs(run);
  eval->add_option("--device", options->run.engine.device,
                   "Number or part of the name of the device, see surefield devices; default: the best");
  add_trajectory_options(*eval, options->trajectory)->excludes(run);
  add_mesh_options(*eval, options->mesh);
  CLI::Option* loops = add_loop_options(*eval, options->loops);
  loops->excludes(run);
  for (const char* other : {"--trajectory", "--ground-truth-mesh"}) loops->excludes(eval->get_option(other));
  eval->add_option("--json", options->run.json, "Also writes what was measured to this file");
  eval->footer(kEvalExamples);
  eval->callback([options, &action] { action = [options] { return evaluate(*options); }; });
}

}  // namespace surefield
