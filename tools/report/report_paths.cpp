// The paths of runs, and the axes in which reports show them.
#include "tools/report/report_paths.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace surefield {

PrincipalAxes principal_axes(const std::vector<Eigen::Vector3d>& positions,
                             const std::optional<Eigen::Vector3d>& up) {
  PrincipalAxes result;
  result.upright = up.has_value();
  for (const Eigen::Vector3d& position : positions) result.centre += position;
  result.centre /= static_cast<double>(std::max<std::size_t>(1, positions.size()));
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& position : positions) {
    spread += (position - result.centre) * (position - result.centre).transpose();
  }
  if (up) {  // makes up the least axis
    const Eigen::Matrix3d level = Eigen::Matrix3d::Identity() - *up * up->transpose();
    spread = level * spread * level + spread.trace() * 1e-6 * level;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  for (int row = 0; row < 3; ++row) {
    Eigen::Vector3d axis = solver.eigenvectors().col(2 - row);
    // An eigenvector's sign is arbitrary; this makes it always the same.
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0) axis = -axis;
    result.axes.row(row) = axis.transpose();
  }
  if (up) result.axes.row(2) = up->transpose();
  return result;
}

std::optional<Eigen::Vector3d> up_of(const std::vector<ReportRun>& runs, const RunGroup& group) {
  for (int i : group.runs) {
    const nlohmann::json& up = runs[i].folder.metrics.value("up", nlohmann::json());
    if (!up.is_object() || !up.value("measured", false)) continue;
    const auto direction = up.value("direction", std::vector<double>());
    if (direction.size() != 3) continue;
    const Eigen::Vector3d in_run(direction[0], direction[1], direction[2]);
    if (!(in_run.norm() > 0.5)) continue;
    return runs[i].accuracy ? Eigen::Vector3d(runs[i].accuracy->alignment.linear() * in_run.normalized())
                            : in_run.normalized();
  }
  return std::nullopt;
}

std::vector<Path> paths_of(const std::vector<ReportRun>& runs, const RunGroup& group) {
  std::vector<Path> paths;
  for (int i : group.runs) {
    if (runs[i].pairs.empty() || !paths.empty()) continue;
    paths.push_back({"ground truth", kReferenceColour, {}});
    for (const PosePair& pair : runs[i].pairs) paths.back().positions.push_back(pair.truth.translation());
  }
  const bool have_truth = !paths.empty();
  for (int i : group.runs) {
    if (have_truth && runs[i].pairs.empty()) continue;  // in a world of its own
    Path path{runs[i].label, i, {}};
    const Eigen::Isometry3d world =
        runs[i].accuracy ? runs[i].accuracy->alignment : Eigen::Isometry3d::Identity();
    for (const StampedPose& pose : runs[i].folder.trajectory) {
      path.positions.push_back((world * pose.camera_to_world).translation());
    }
    paths.push_back(std::move(path));
  }
  return paths;
}

Plot map_plot(const std::string& title, const std::vector<Path>& paths, const PrincipalAxes& axes,
              int second) {
  static const char *const kAxes[] = {"1st axis, m", "2nd axis, m", "3rd axis, m"}, *const kUp = "up, m";
  Plot plot{.title = title,
            .x_label = kAxes[0],
            .y_label = second == 2 && axes.upright ? kUp : kAxes[second],
            .equal_scale = true};
  for (const Path& path : paths) {
    PlotSeries series{path.name, path.colour, {}};
    for (const Eigen::Vector3d& position : path.positions) {
      const Eigen::Vector3d at = axes.of(position);
      series.points.emplace_back(at[0], at[second]);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::vector<RunGroup> group_by_dataset(const std::vector<ReportRun>& runs) {
  std::vector<RunGroup> groups;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::string name = runs[i].dataset_name();
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const RunGroup& g) { return g.dataset == name; });
    if (group == groups.end()) group = groups.insert(groups.end(), {name, {}});
    group->runs.push_back(static_cast<int>(i));
  }
  return groups;
}

}  // namespace surefield
