#include "tools/eval/eval_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <vector>

#include "engine/io/files.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
#include "tools/results/trajectory_report.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

const std::map<std::string, Alignment>& alignments() {
  static const std::map<std::string, Alignment> names = {
      {"none", Alignment::None}, {"se3", Alignment::Rigid}, {"sim3", Alignment::Similarity}};
  return names;
}

std::string name_of(Alignment alignment) {
  for (const auto& [name, value] : alignments())
    if (value == alignment) return name;
  return {};
}

/// The true trajectory, and when the frames of its dataset were taken.
struct Truth {
  TrajectoryFile file;
  std::string format;  ///< name for people
  std::vector<double> frame_stamps;
};

Truth truth_of_file(const std::string& path) {
  TrajectoryFile file = read_any_trajectory(path);
  const std::string format = name_of(file.format);
  return {std::move(file), format, {}};
}

Truth truth_of_dataset(const std::string& path) {
  Dataset dataset = open_dataset(path);
  if (!dataset.ground_truth) throw InputError(path, "this dataset has no ground truth");
  std::vector<double> stamps;
  for (int i = 0; i < dataset.recording->count(); ++i) stamps.push_back(dataset.recording->timestamp(i));
  return {{*std::move(dataset.ground_truth)}, "dataset " + dataset.recording->format(), std::move(stamps)};
}

Truth read_truth(const std::string& path) {
  const bool dataset = folder_exists(path) || std::filesystem::path(path).extension() == ".sens";
  return dataset ? truth_of_dataset(path) : truth_of_file(path);
}

std::vector<double> stamps_of(const Trajectory& poses) {
  std::vector<double> stamps;
  for (const StampedPose& pose : poses) stamps.push_back(pose.timestamp);
  return stamps;
}

void set_stamps(TrajectoryFile& file, const std::vector<double>& stamps) {
  for (std::size_t i = 0; i < stamps.size(); ++i) file.poses[i].timestamp = stamps[i];
  file.numbered = false;
}

/// Whether the stamps of a trajectory are numbers of poses in a file of `count`.
bool are_numbers_below(const Trajectory& poses, std::size_t count) {
  return std::all_of(poses.begin(), poses.end(), [&](const StampedPose& pose) {
    return pose.timestamp == std::floor(pose.timestamp) && pose.timestamp >= 0 &&
           pose.timestamp < static_cast<double>(count);
  });
}

/// Gives stamps to the poses that are only numbered. Throws InputError where it is unknown which belongs to
/// which.
void match_numbered(const TrajectoryEvaluation& evaluation, TrajectoryFile& estimate, Truth& truth) {
  if (!evaluation.stamps.empty()) {
    const std::vector<double> stamps = read_stamps(evaluation.stamps);
    bool used = false;
    for (TrajectoryFile* file : {&estimate, &truth.file}) {
      if (!file->numbered || file->poses.size() != stamps.size()) continue;
      set_stamps(*file, stamps);
      used = true;
    }
    if (!used) {
      throw InputError(evaluation.stamps,
                       fmt::format("has {} stamps, and neither trajectory has as many poses without stamps",
                                   stamps.size()));
    }
  }
  const std::size_t poses = estimate.poses.size(), true_poses = truth.file.poses.size();
  if (estimate.numbered && poses == truth.frame_stamps.size()) {
    set_stamps(estimate, truth.frame_stamps);
  } else if (estimate.numbered && poses == true_poses) {
    set_stamps(estimate, stamps_of(truth.file.poses));
  } else if (truth.file.numbered && !estimate.numbered && poses == true_poses) {
    set_stamps(truth.file, stamps_of(estimate.poses));
  } else if (estimate.numbered || (truth.file.numbered && !are_numbers_below(estimate.poses, true_poses))) {
    const bool of_estimate = estimate.numbered;
    throw InputError(
        of_estimate ? evaluation.estimate : evaluation.ground_truth,
        fmt::format("its {} poses have no stamps, and the {} has {} poses: which belongs to which "
                    "is unknown; give one pose a frame, or --stamps FILE with a stamp for each",
                    of_estimate ? poses : true_poses, of_estimate ? "truth" : "estimate",
                    of_estimate ? true_poses : poses));
  }
}

std::string described(const char* what, const std::string& format, const TrajectoryFile& file) {
  return fmt::format("{:<16} {}, {} poses{}\n", what, format, file.poses.size(),
                     file.numbered ? " without stamps" : "");
}

}  // namespace

CLI::Option* add_trajectory_options(CLI::App& eval, TrajectoryEvaluation& evaluation) {
  CLI::Option* trajectory =
      eval.add_option("--trajectory", evaluation.estimate, "Trajectory of any system, in any known format");
  CLI::Option* truth = eval.add_option("--ground-truth", evaluation.ground_truth,
                                       "True trajectory, in any known format, or a dataset");
  trajectory->needs(truth);
  truth->needs(trajectory);
  eval.add_option_function<std::string>(
          "--align", [&evaluation](const std::string& name) { evaluation.alignment = alignments().at(name); },
          "Transform to the truth: se3 (rigid), sim3 (with scale), or none")
      ->check(CLI::IsMember(alignments()))
      ->type_name("KIND")
      ->default_str("se3")
      ->needs(trajectory);
  eval.add_option_function<std::string>(
          "--trajectory-format",
          [&evaluation](const std::string& name) { evaluation.format = trajectory_formats().at(name); },
          "Format of --trajectory where its content does not tell")
      ->check(CLI::IsMember(trajectory_formats()))
      ->type_name("FORMAT")
      ->needs(trajectory);
  eval.add_option("--stamps", evaluation.stamps,
                  "File with the time stamps of poses that have none, one a line, as KITTI's times.txt")
      ->needs(trajectory);
  return trajectory;
}

int evaluate_trajectories(const TrajectoryEvaluation& evaluation) {
  TrajectoryFile estimate = read_any_trajectory(evaluation.estimate, {.format = evaluation.format});
  Truth truth = read_truth(evaluation.ground_truth);
  std::string text = described("estimate", name_of(estimate.format), estimate);
  text += described("truth", truth.format, truth.file);
  match_numbered(evaluation, estimate, truth);
  const TrajectoryMetrics metrics =
      evaluate_trajectory(estimate.poses, truth.file.poses, {.alignment = evaluation.alignment});
  if (!evaluation.json.empty()) {
    nlohmann::ordered_json json = {{"schema", "surefield-trajectory"},
                                   {"version", 1},
                                   {"format", name_of(estimate.format)},
                                   {"alignment", name_of(evaluation.alignment)},
                                   {"scale", metrics.scale}};
    json.update(trajectory_json(metrics));
    write_file(evaluation.json, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
  }
  if (evaluation.alignment == Alignment::Similarity)
    text += fmt::format("scale            {:.6g}\n", metrics.scale);
  fmt::print("{}{}", text, trajectory_table(metrics));
  return kSuccess;
}

}  // namespace surefield
