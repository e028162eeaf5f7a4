// Places that a run came back to, as a report shows them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/report/html.h"
#include "engine/session/loop_table.h"
#include "tools/report/report_paths.h"
#include "tools/report/report_sections.h"

namespace surefield {

namespace {

constexpr int kAcceptedColour = 2, kRejectedColour = 1;  // beside kReferenceColour of the path
constexpr std::size_t kRowsShown = 200;                  // of the table; loops.csv has all

std::vector<StoredLoop> loops_of(const ReportRun& run) {
  const std::filesystem::path file = run.folder.path / "loops.csv";
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {};
  return read_loops(file);
}

/// "3 accepted, 5 few matches, 1 seen through": each verdict with its number.
std::string count_verdicts(const std::vector<StoredLoop>& loops) {
  std::map<std::string, int> counts;
  for (const StoredLoop& loop : loops)
    ++counts[!loop.why.empty() ? loop.why : loop.accepted ? "accepted" : "rejected"];
  std::string text;
  for (const auto& [why, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, why);
  return text;
}

/// Where the camera was at each frame, by Frame::index, in the world of paths_of().
std::map<int, Eigen::Vector3d> positions_of(const ReportRun& run) {
  const Eigen::Isometry3d world = run.accuracy ? run.accuracy->alignment : Eigen::Isometry3d::Identity();
  std::map<int, Eigen::Vector3d> positions;
  for (std::size_t i = 0; i < run.frames(); ++i)
    positions[run.frame(i).value("index", 0)] =
        (world * run.folder.trajectory[i].camera_to_world).translation();
  return positions;
}

/// The path, and a line between the two keyframes of each loop.
std::string edge_figure(const std::vector<ReportRun>& runs, int r, const std::vector<StoredLoop>& loops) {
  const std::map<int, Eigen::Vector3d> positions = positions_of(runs[r]);
  Path path{"path", kReferenceColour, {}};
  for (const auto& [index, position] : positions) path.positions.push_back(position);
  const PrincipalAxes axes = principal_axes(path.positions, up_of(runs, {"", {r}}));
  Path accepted{"taken for true", kAcceptedColour, {}}, rejected{"not", kRejectedColour, {}};
  for (const StoredLoop& loop : loops) {
    const auto from = positions.find(loop.measured.from), to = positions.find(loop.measured.to);
    if (from == positions.end() || to == positions.end()) continue;
    std::vector<Eigen::Vector3d>& line = (loop.accepted ? accepted : rejected).positions;
    line.insert(line.end(), {from->second, to->second, Eigen::Vector3d::Constant(kNone)});
  }
  Plot plot = map_plot(axes.upright ? "Loops from above" : "Loops along the principal axes",
                       {path, rejected, accepted}, axes, 1);
  std::erase_if(plot.series, [](const PlotSeries& series) { return series.points.empty(); });
  return plot_figure(plot);
}

/// Positions' errors over frames, as the poses were when the frames came and as they are in the end.
std::string drift_figure(const ReportRun& run) {
  if (!run.dataset || !run.dataset->ground_truth || !run.accuracy || !run.folder.online) return "";
  const Trajectory &truth = *run.dataset->ground_truth, &online = *run.folder.online;
  Plot plot{.title = "Error of the position, as each frame came and in the end",
            .x_label = "frame",
            .y_label = "cm"};
  std::map<double, int> index_at;
  for (std::size_t i = 0; i < run.frames(); ++i)
    index_at[run.folder.trajectory[i].timestamp] = run.frame(i).value("index", 0);
  const Eigen::Isometry3d alignment = evaluate_trajectory(online, truth).alignment;
  PlotSeries when_it_came{"as it came", kRejectedColour, {}}, in_the_end{"in the end", kAcceptedColour, {}};
  for (const PosePair& pair : associate(online, truth)) {
    const double error = (alignment * pair.estimate.translation() - pair.truth.translation()).norm();
    when_it_came.points.emplace_back(index_at[pair.timestamp], 100 * error);
  }
  for (const FrameError& error : run.errors)
    in_the_end.points.emplace_back(run.frame(error.frame).value("index", 0), 100 * error.position);
  plot.series = {when_it_came, in_the_end};
  return plot_figure(plot);
}

/// Empty for what the judgement did not get to, which loops.csv has as 0.
std::string cell(double value, const char* format) {
  return "<td>" + (std::isfinite(value) && value != 0 ? fmt::format(fmt::runtime(format), value) : "") +
         "</td>";
}

std::string table_of(std::vector<StoredLoop> loops) {
  std::stable_sort(loops.begin(), loops.end(),
                   [](const StoredLoop& a, const StoredLoop& b) { return a.accepted > b.accepted; });
  std::string html =
      "<details><summary>All places that looked known</summary>\n<div class=\"wide\"><table>\n<thead><tr>"
      "<th>frames</th><th>verdict</th><th>similarity</th><th>shared</th><th>seen through</th><th>correction "
      "<small>cm</small></th><th><small>degrees</small></th></tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < std::min(loops.size(), kRowsShown); ++i) {
    const StoredLoop& loop = loops[i];
    html += fmt::format("<tr><th>{} to {}</th><td{}>{}</td>", loop.measured.to, loop.measured.from,
                        loop.accepted ? " class=\"best\"" : "", escape_html(loop.why));
    html += cell(loop.similarity, "{:.2f}") + cell(100 * loop.overlap, "{:.0f} %") +
            cell(100 * loop.see_through, "{:.1f} %") + cell(100 * loop.correction_m, "{:.2f}") +
            cell(loop.correction_deg, "{:.2f}") + "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (loops.size() > kRowsShown)
    html += fmt::format("<p class=\"note\">The first {} of {}; loops.csv has all.</p>\n", kRowsShown,
                        loops.size());
  return html + "</details>\n";
}

}  // namespace

std::string loop_section(const std::vector<ReportRun>& runs) {
  std::string html;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::vector<StoredLoop> loops = loops_of(runs[r]);
    if (loops.empty()) continue;
    html += fmt::format("{}<p class=\"note\">{} places looked known: {}.</p>\n",
                        runs.size() > 1 ? "<h3>" + escape_html(runs[r].label) + "</h3>\n" : "", loops.size(),
                        escape_html(count_verdicts(loops)));
    html += "<div class=\"figures\">\n" + edge_figure(runs, static_cast<int>(r), loops) +
            drift_figure(runs[r]) + "</div>\n" + table_of(loops);
  }
  if (html.empty()) return html;
  return "<section><h2>Loops</h2>\n<p class=\"note\">Places that the camera came back to, and how they were "
         "judged (docs/places.md).</p>\n" +
         html + "</section>\n";
}

}  // namespace surefield
