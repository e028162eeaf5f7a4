// surefield eval: how far a trajectory is from the truth.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "engine/io/dataset.h"
#include "engine/io/error.h"
#include "engine/io/files.h"
#include "tools/command.h"
#include "tools/trajectory_report.h"

namespace surefield {

namespace {

constexpr const char* kExamples =
    "The trajectory is aligned to the truth by a rigid transform (Horn, no scale); poses are paired where "
    "their\n"
    "time stamps are at most 0.02 s apart. The errors are defined in docs/evaluation.md.\n"
    "\n"
    "Examples:\n"
    "  surefield eval --trajectory out/desk/trajectory.txt --ground-truth rgbd_dataset_freiburg1_desk\n"
    "  surefield eval --trajectory out/desk/keyframes.txt --ground-truth groundtruth.txt --json "
    "errors.json\n";

struct EvalOptions {
  std::string trajectory;
  std::string ground_truth;  ///< a TUM file or the folder of a dataset
  std::string json;          ///< file to write; empty: none
};

Trajectory read_ground_truth(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return read_trajectory(path);
  const auto dataset = open_dataset(path);
  if (!dataset->ground_truth()) throw InputError(path, "this dataset has no ground truth");
  return *dataset->ground_truth();
}

int evaluate(const EvalOptions& options) {
  const Trajectory estimate = read_trajectory(options.trajectory);
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, read_ground_truth(options.ground_truth));
  if (!options.json.empty()) {
    nlohmann::ordered_json json = {{"schema", "surefield-trajectory"}, {"version", 1}};
    json.update(trajectory_json(metrics));
    write_file(options.json, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
  }
  fmt::print("{}", trajectory_table(metrics));
  return kSuccess;
}

}  // namespace

void add_eval(CLI::App& program, Action& action) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* eval = program.add_subcommand("eval", "Measures the error of a trajectory against ground truth");
  eval->add_option("--trajectory", options->trajectory, "Trajectory in TUM format")->required();
  eval->add_option("--ground-truth", options->ground_truth,
                   "True trajectory in TUM format, or the folder of a dataset")
      ->required();
  eval->add_option("--json", options->json, "Also writes the errors to this file");
  eval->footer(kExamples);
  eval->callback([options, &action] { action = [options] { return evaluate(*options); }; });
}

}  // namespace surefield
