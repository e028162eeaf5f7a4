// Plots of a report: trajectories, and what happened frame by frame.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "engine/report/plot.h"
#include "tools/report/report_paths.h"
#include "tools/report/report_sections.h"

namespace surefield {

namespace {

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
