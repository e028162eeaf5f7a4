#include "tools/report/report_data.h"

#include <Eigen/SVD>
#include <set>

#include "engine/types/error.h"

namespace surefield {

namespace {

void open_run_dataset(ReportRun& run, const std::string& instead) {
  try {
    run.dataset = open_dataset_of(run.folder, instead);
  } catch (const InputError& error) {
    if (!instead.empty()) throw;
    run.dataset_problem = error.what();
  }
}

/// The rotation that takes the estimated orientations to the true ones best (chordal mean). That of the
/// positions' alignment will not do: a path that is nearly straight leaves the turn about it open.
Eigen::Matrix3d align_orientations(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) sum += pair.truth.linear() * pair.estimate.linear().transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

void measure_errors(ReportRun& run) {
  if (!run.dataset || !run.dataset->ground_truth) return;
  const Trajectory& truth = *run.dataset->ground_truth;
  try {
    run.accuracy = evaluate_trajectory(run.folder.trajectory, truth);
  } catch (const InputError& error) {
    run.truth_problem = error.what();
    return;
  }
  std::map<double, int> frame_at;
  for (std::size_t i = 0; i < run.frames(); ++i) {
    frame_at[run.folder.trajectory[i].timestamp] = static_cast<int>(i);
  }
  run.pairs = associate(run.folder.trajectory, truth);
  const Eigen::Matrix3d rotation = align_orientations(run.pairs);
  for (std::size_t i = 0; i < run.pairs.size(); ++i) {
    PosePair& pair = run.pairs[i];
    const Eigen::Matrix3d turned = pair.truth.linear().transpose() * rotation * pair.estimate.linear();
    pair.estimate = run.accuracy->alignment * pair.estimate;
    const double distance = (pair.estimate.translation() - pair.truth.translation()).norm();
    run.errors.push_back({frame_at[pair.timestamp], distance, Eigen::AngleAxisd(turned).angle()});
    if (i > 0) run.path_length += (pair.truth.translation() - run.pairs[i - 1].truth.translation()).norm();
  }
}

}  // namespace

std::vector<ReportRun> load_report_runs(const std::vector<std::string>& folders, const std::string& dataset) {
  std::vector<ReportRun> runs;
  std::multiset<std::string> names;
  for (const std::string& folder : folders) {
    ReportRun run;
    run.folder = read_run(folder);
    names.insert(run.folder.name);
    open_run_dataset(run, dataset);
    measure_errors(run);
    runs.push_back(std::move(run));
  }
  for (ReportRun& run : runs) {
    run.label = names.count(run.folder.name) > 1 ? run.folder.path.string() : run.folder.name;
  }
  return runs;
}

}  // namespace surefield
