// Plots of a report: trajectories, and what happened frame by frame.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/report/plot.h"
#include "tools/report/report_sections.h"

namespace surefield {

namespace {

/// The axes along which positions spread: most, less, least; where up is known, the third is that and the
/// others are level. World to axes.
struct PrincipalAxes {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< one a row
  bool upright = false;                                ///< the third is up

  Eigen::Vector3d of(const Eigen::Vector3d& position) const { return axes * (position - centre); }
};

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

/// Where up is in the world of paths_of(), by the first run of the group whose map tells.
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

/// A line through space.
struct Path {
  std::string name;
  int colour = 0;
  std::vector<Eigen::Vector3d> positions;
};

/// The truth, if a run of the group knows it, and the runs' paths in its world.
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

/// A plot of one value of each frame over all runs.
class FramePlot {
 public:
  /// What to plot of the frame at a position among those fed; NaN for nothing.
  using Value = std::function<double(const ReportRun&, std::size_t)>;

  FramePlot(const std::string& title, const std::string& y_label) {
    plot_.title = title;
    plot_.x_label = "frame";
    plot_.y_label = y_label;
  }

  FramePlot& add(const std::vector<ReportRun>& runs, const Value& value) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      PlotSeries series{runs[r].label, static_cast<int>(r), {}};
      for (std::size_t i = 0; i < runs[r].frames(); ++i) {
        series.points.emplace_back(runs[r].frame(i).value("index", 0), value(runs[r], i));
      }
      plot_.series.push_back(std::move(series));
    }
    return *this;
  }

  /// Marks the frames that were lost.
  FramePlot& mark_lost(const std::vector<ReportRun>& runs) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      for (std::size_t i = 0; i < runs[r].frames(); ++i) {
        if (!runs[r].frame(i).value("lost", false)) continue;
        const Eigen::Vector2d& at = plot_.series[r].points[i];
        if (at.allFinite())
          plot_.marks.push_back({at, fmt::format("{}: frame {} lost", runs[r].label, at.x())});
      }
    }
    return *this;
  }

  std::string figure() const { return plot_figure(plot_); }

 private:
  Plot plot_;
};

double number_of(const ReportRun& run, std::size_t i, const char* key) {
  const nlohmann::json& frame = run.frame(i);
  return frame.contains(key) && frame[key].is_number() ? frame[key].get<double>() : kNone;
}

FramePlot::Value column(const char* key, double factor = 1) {
  return [=](const ReportRun& run, std::size_t i) { return factor * number_of(run, i, key); };
}

/// A column of the frames that were tracked, which the first was not.
FramePlot::Value tracked(const char* key, double factor = 1) {
  return [=](const ReportRun& run, std::size_t i) { return i > 0 ? factor * number_of(run, i, key) : kNone; };
}

std::string error_figures(const std::vector<ReportRun>& runs) {
  const auto error = [](double FrameError::*part, double factor) {
    return [=](const ReportRun& run, std::size_t i) {
      for (const FrameError& each : run.errors) {
        if (each.frame == static_cast<int>(i)) return factor * each.*part;
      }
      return kNone;
    };
  };
  return FramePlot("Position error after alignment", "cm")
             .add(runs, error(&FrameError::position, 100))
             .mark_lost(runs)
             .figure() +
         FramePlot("Rotation error after alignment", "degrees")
             .add(runs, error(&FrameError::rotation, 180 / std::numbers::pi))
             .mark_lost(runs)
             .figure();
}

std::string stage_figure(const std::vector<ReportRun>& runs) {
  BarChart chart{"Time per stage", "s", {"tracking", "mapping", "waiting and the rest"}, {}};
  for (const ReportRun& run : runs) {
    const double tracking = run.folder.number("/time/tracking_s"),
                 mapping = run.folder.number("/time/mapping_s");
    if (!std::isfinite(tracking + mapping)) continue;  // it ended before anything was timed
    const double total = run.folder.number("/time/total_s");
    const double rest = std::isfinite(total) ? std::max(0.0, total - tracking - mapping) : 0;
    chart.bars.push_back({run.label, {tracking, mapping, rest}});
  }
  return chart.bars.empty() ? "" : bar_figure(chart);
}

}  // namespace

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

std::string trajectory_section(const std::vector<ReportRun>& runs) {
  std::string html =
      "<section><h2>Trajectory</h2>\n<p class=\"note\">In the principal axes of the path: the first is that "
      "along which it is longest, the third that along which it is shortest. Where the map tells where up "
      "is, "
      "the first two are level and the third is up. Rings mark the start.</p>\n";
  const std::vector<RunGroup> groups = group_by_dataset(runs);
  for (const RunGroup& group : groups) {
    const std::vector<Path> paths = paths_of(runs, group);
    const PrincipalAxes axes = principal_axes(paths.front().positions, up_of(runs, group));
    const std::string prefix = groups.size() > 1 ? group.dataset + ": " : "";
    html += "<div class=\"figures\">\n" +
            plot_figure(map_plot(prefix + (axes.upright ? "From above" : "1st and 2nd principal axis"), paths,
                                 axes, 1)) +
            plot_figure(map_plot(prefix + (axes.upright ? "From the side" : "1st and 3rd principal axis"),
                                 paths, axes, 2)) +
            "</div>\n";
  }
  return html + "</section>\n";
}

std::string progress_section(const std::vector<ReportRun>& runs) {
  const auto mapped = [](const ReportRun& run, std::size_t i) {
    return i > 0 && run.frame(i).value("keyframe", false) ? number_of(run, i, "mapping_ms") : 0;
  };
  std::string html = "<section><h2>Frame by frame</h2>\n<div class=\"figures\">\n";
  html += error_figures(runs);
  html += FramePlot("Tracking loss", "loss").add(runs, tracked("loss")).mark_lost(runs).figure();
  html += FramePlot("Depth that the map explains", "%")
              .add(runs, tracked("explained", 100))
              .mark_lost(runs)
              .figure();
  html += FramePlot("Standard deviation of the position", "cm")
              .add(runs, tracked("sigma_cm"))
              .mark_lost(runs)
              .figure();
  html += FramePlot("Tracking iterations", "iterations").add(runs, tracked("tracking_iterations")).figure();
  html += FramePlot("Gaussians in the map", "thousands").add(runs, column("gaussians", 1e-3)).figure();
  html += FramePlot("Device memory in use", "MB").add(runs, column("device_mb")).figure();
  html += FramePlot("Tracking time", "ms").add(runs, tracked("tracking_ms")).figure();
  html += FramePlot("Mapping time, without the first frame", "ms").add(runs, mapped).figure();
  return html + "</div>\n" + stage_figure(runs) + "</section>\n";
}

}  // namespace surefield
