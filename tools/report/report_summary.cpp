// The first thing that a report says: how good the runs were.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>

#include "engine/report/html.h"
#include "tools/report/report_sections.h"
#include "tools/report/report_verdict.h"

namespace surefield {

namespace {

/// Which of two values is the better one.
enum class Better { Lower, Higher, Neither };

/// A line of the table of all measures.
struct Measure {
  const char* name;
  const char* unit;
  int decimals;
  Better better;
  std::function<double(const ReportRun&)> value;  ///< NaN where there is none
};

/// A value of metrics.json, times a factor.
std::function<double(const ReportRun&)> metric(const std::string& pointer, double factor = 1) {
  return [=](const ReportRun& run) { return factor * run.folder.number(pointer); };
}

std::function<double(const ReportRun&)> ratio(const std::string& above, const std::string& below,
                                              double factor = 1) {
  return [=](const ReportRun& run) {
    const double divisor = run.folder.number(below);
    return divisor > 0 ? factor * run.folder.number(above) / divisor : kNone;
  };
}

/// Measured anew where the dataset is there, since --dataset may name one with better truth.
std::function<double(const ReportRun&)> accuracy(double ErrorStatistics::*part, const std::string& pointer) {
  return [=](const ReportRun& run) {
    return 100 * (run.accuracy ? run.accuracy->ate.*part : run.folder.number(pointer));
  };
}

struct MeasureGroup {
  const char* title;
  std::vector<Measure> measures;
};

std::vector<MeasureGroup> accuracy_groups() {
  const double degrees = 180 / M_PI;
  return {
      {"Trajectory",
       {{"ATE RMSE", "cm", 3, Better::Lower, accuracy(&ErrorStatistics::rmse, "/trajectory/ate_rmse_m")},
        {"ATE mean", "cm", 3, Better::Lower, accuracy(&ErrorStatistics::mean, "/trajectory/ate_mean_m")},
        {"ATE median", "cm", 3, Better::Lower,
         accuracy(&ErrorStatistics::median, "/trajectory/ate_median_m")},
        {"ATE largest", "cm", 3, Better::Lower, accuracy(&ErrorStatistics::max, "/trajectory/ate_max_m")},
        {"ATE RMSE, keyframes only", "cm", 3, Better::Lower, metric("/trajectory/keyframes_ate_rmse_m", 100)},
        {"RPE per frame", "cm", 3, Better::Lower, metric("/trajectory/rpe_translation_rmse_m", 100)},
        {"RPE per frame", "degrees", 4, Better::Lower, metric("/trajectory/rpe_rotation_rmse_rad", degrees)},
        {"RPE per second", "cm", 3, Better::Lower, metric("/trajectory/rpe_1s_translation_rmse_m", 100)},
        {"RPE per second", "degrees", 4, Better::Lower,
         metric("/trajectory/rpe_1s_rotation_rmse_rad", degrees)}}},
      {"Images, all frames",
       {{"PSNR", "dB", 2, Better::Higher, metric("/images/psnr_db")},
        {"SSIM", "", 4, Better::Higher, metric("/images/ssim")},
        {"Depth L1", "cm", 2, Better::Lower, metric("/images/depth_l1_m", 100)}}},
      {"Space, all frames",
       {{"Floaters", "%", 2, Better::Lower, metric("/images/floaters", 100)},
        {"Coverage", "%", 1, Better::Higher, metric("/images/coverage", 100)}}},
      {"Images, held-out frames",
       {{"PSNR", "dB", 2, Better::Higher, metric("/images/held_out/psnr_db")},
        {"SSIM", "", 4, Better::Higher, metric("/images/held_out/ssim")},
        {"Depth L1", "cm", 2, Better::Lower, metric("/images/held_out/depth_l1_m", 100)}}}};
}

std::vector<MeasureGroup> cost_groups() {
  return {{"Runtime",
           {{"Speed", "frames/s", 2, Better::Higher, metric("/time/frames_per_second")},
            {"Tracking, each frame", "ms", 1, Better::Lower, ratio("/time/tracking_s", "/frames/fed", 1000)},
            {"Mapping, each keyframe", "ms", 1, Better::Lower,
             ratio("/time/mapping_s", "/frames/keyframes", 1000)},
            {"Tracking, each iteration", "ms", 2, Better::Lower, metric("/time/tracking_ms_per_iteration")},
            {"Tracking iterations", "a frame", 1, Better::Lower,
             ratio("/time/tracking_iterations", "/frames/fed")},
            {"Mapping, each iteration", "ms", 2, Better::Lower, metric("/time/mapping_ms_per_iteration")},
            {"Mapping iterations", "a keyframe", 1, Better::Lower,
             ratio("/time/mapping_iterations", "/frames/keyframes")},
            {"Total", "s", 1, Better::Lower, metric("/time/total_s")}}},
          {"Memory",
           {{"Gaussians", "", 0, Better::Lower, metric("/map/gaussians")},
            {"Map in memory", "MB", 2, Better::Lower, metric("/map/megabytes")},
            {"Device, at most", "MB", 1, Better::Lower, metric("/memory/device_peak_mb")},
            {"Host, at most", "MB", 1, Better::Lower, metric("/memory/host_peak_mb")}}},
          {"Frames",
           {{"Selected", "", 0, Better::Neither, metric("/frames/total")},
            {"Fed", "", 0, Better::Neither, metric("/frames/fed")},
            {"Keyframes", "", 0, Better::Neither, metric("/frames/keyframes")},
            {"Tracked again from another pose", "", 0, Better::Lower, metric("/frames/retried")},
            {"Poor", "", 0, Better::Lower, metric("/frames/poor")},
            {"Lost", "", 0, Better::Lower, metric("/frames/lost")},
            {"With a pose", "%", 1, Better::Higher, metric("/frames/pose_share", 100)},
            {"Skipped", "", 0, Better::Lower, metric("/frames/skipped")}}}};
}

std::string shown(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

bool same_dataset(const std::vector<ReportRun>& runs) {
  return group_by_dataset(runs).size() == 1;
}

/// The best value of several runs; NaN where none is to be singled out: runs of different datasets do not
/// compete, and equal ones are all the best.
double best_value(const Measure& measure, const std::vector<ReportRun>& runs) {
  if (runs.size() < 2 || measure.better == Better::Neither || !same_dataset(runs)) return kNone;
  double lowest = kNone, highest = kNone;
  for (const ReportRun& run : runs) {
    lowest = std::fmin(lowest, measure.value(run));
    highest = std::fmax(highest, measure.value(run));
  }
  if (lowest == highest) return kNone;
  return measure.better == Better::Higher ? highest : lowest;
}

/// The line of one measure, the best run in bold; empty where no run has it.
std::string measure_row(const Measure& measure, const std::vector<ReportRun>& runs) {
  const double best = best_value(measure, runs);
  std::string cells;
  bool any = false;
  for (const ReportRun& run : runs) {
    const double value = measure.value(run);
    any = any || std::isfinite(value);
    cells +=
        fmt::format("<td{}>{}</td>", value == best ? " class=\"best\"" : "", shown(value, measure.decimals));
  }
  if (!any) return "";
  return fmt::format("<tr><th>{} <small>{}</small></th>{}</tr>\n", measure.name, measure.unit, cells);
}

std::string count_of(const ReportRun& run, const char* key, const char* what) {
  const double count = run.folder.number(std::string("/frames/") + key);
  return count > 0 ? fmt::format(", {:.0f} {}", count, what) : "";
}

std::string verdict_text(const ReportRun& run) {
  const std::string status = run.folder.text("/status");
  const double total = run.folder.number("/frames/total");
  std::string text = shown(run.folder.number("/frames/fed"), 0) +
                     (std::isfinite(total) ? fmt::format(" of {:.0f}", total) : "") + " frames tracked";
  text += count_of(run, "poor", "poor") + count_of(run, "lost", "lost") + count_of(run, "skipped", "skipped");
  if (status != "completed")
    text += "; the run " + (status == "failed" ? "failed: " + run.folder.text("/error") : "was interrupted");
  if (run.accuracy) {
    text += fmt::format("; positions off by {:.2f} cm (RMSE), {:.2f} cm at most",
                        100 * run.accuracy->ate.rmse, 100 * run.accuracy->ate.max);
    if (run.path_length > 0) {
      text += fmt::format(", on a path of {:.2f} m ({:.2f} %)", run.path_length,
                          100 * run.accuracy->ate.rmse / run.path_length);
    }
  } else if (!std::isnan(run.folder.number("/trajectory/ate_rmse_m"))) {
    text +=
        fmt::format("; positions off by {:.2f} cm (RMSE)", 100 * run.folder.number("/trajectory/ate_rmse_m"));
  } else {
    text += "; " + (run.truth_problem.empty() ? "no ground truth to compare with" : run.truth_problem);
  }
  const double psnr = run.folder.number("/images/psnr_db");
  if (std::isfinite(psnr)) text += fmt::format("; renders match the images with {:.1f} dB", psnr);
  return text + ".";
}

/// The measures by which runs are compared first.
std::vector<Measure> headline_measures() {
  return {{"ATE RMSE", "cm", 3, Better::Lower, accuracy(&ErrorStatistics::rmse, "/trajectory/ate_rmse_m")},
          {"RPE per second", "cm", 3, Better::Lower, metric("/trajectory/rpe_1s_translation_rmse_m", 100)},
          {"PSNR", "dB", 2, Better::Higher, metric("/images/psnr_db")},
          {"Depth L1", "cm", 2, Better::Lower, metric("/images/depth_l1_m", 100)},
          {"Speed", "frames/s", 2, Better::Higher, metric("/time/frames_per_second")},
          {"Gaussians", "", 0, Better::Lower, metric("/map/gaussians")},
          {"Lost", "frames", 0, Better::Lower, metric("/frames/lost")}};
}

/// Several runs, one a row, by their headline measures; the best of each in bold.
std::string comparison(const std::vector<ReportRun>& runs) {
  const std::vector<Measure> measures = headline_measures();
  std::string html = "<div class=\"wide\"><table class=\"runs\">\n<thead><tr><th>run</th><th>dataset</th>";
  for (const Measure& measure : measures) {
    html += fmt::format("<th>{}<small>{}</small></th>", measure.name, measure.unit);
  }
  html += "</tr></thead>\n<tbody>";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    html += fmt::format("<tr><th><i style=\"background:var(--run{})\"></i>{}</th><th>{}</th>", i % 8,
                        escape_html(runs[i].label), escape_html(runs[i].dataset_name()));
    for (const Measure& measure : measures) {
      const double value = measure.value(runs[i]);
      html += fmt::format("<td{}>{}</td>", value == best_value(measure, runs) ? " class=\"best\"" : "",
                          shown(value, measure.decimals));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string card(const std::string& name, const std::string& value, const std::string& detail) {
  return fmt::format("<div class=\"card\"><span>{}</span><b>{}</b><small>{}</small></div>", name, value,
                     detail);
}

std::string cards(const ReportRun& run) {
  const auto number = [&](const char* pointer) { return run.folder.number(pointer); };
  const double ate = accuracy(&ErrorStatistics::rmse, "/trajectory/ate_rmse_m")(run);
  const double fed = number("/frames/fed"), keyframes = std::max(1.0, number("/frames/keyframes"));
  std::string html;
  html += card("Trajectory error", std::isnan(ate) ? "–" : shown(ate, 2) + " cm",
               fmt::format("ATE RMSE; {} cm at most",
                           shown(accuracy(&ErrorStatistics::max, "/trajectory/ate_max_m")(run), 2)));
  html += card("Image quality", shown(number("/images/psnr_db"), 1) + " dB",
               fmt::format("PSNR; SSIM {}, depth {} cm", shown(number("/images/ssim"), 3),
                           shown(100 * number("/images/depth_l1_m"), 2)));
  html += card("Speed", shown(number("/time/frames_per_second"), 2) + " frames/s",
               fmt::format("tracking {} ms a frame, mapping {} ms a keyframe",
                           shown(1000 * number("/time/tracking_s") / fed, 1),
                           shown(1000 * number("/time/mapping_s") / keyframes, 1)));
  html += card("Map", shown(number("/map/gaussians") / 1000, 1) + " k",
               fmt::format("Gaussians, {} MB of memory; device {} MB at most",
                           shown(number("/map/megabytes"), 1), shown(number("/memory/device_peak_mb"), 0)));
  return "<div class=\"cards\">" + html + "</div>\n";
}

}  // namespace

std::string verdict_section(const std::vector<ReportRun>& runs) {
  std::string html = "<section class=\"verdicts\">\n";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Verdict verdict = judge(runs[i]);
    html += fmt::format("<p class=\"verdict {0}\"><b title=\"{1}\">{0}</b> ", name_of(verdict.level),
                        verdict_limits());
    if (runs.size() > 1) {
      html += fmt::format("<i style=\"background:var(--run{})\"></i><strong>{}</strong> ", i % 8,
                          escape_html(runs[i].label));
    }
    html += escape_html(verdict_text(runs[i]));
    if (!verdict.reasons.empty())
      html += escape_html(fmt::format(" Not better because of: {}.", fmt::join(verdict.reasons, ", ")));
    html += "</p>\n";
    if (!runs[i].dataset) {
      html += fmt::format(
          "<p class=\"note\">Without errors over time and images, since the dataset is not here: {}</p>\n",
          escape_html(runs[i].dataset_problem));
    }
  }
  html += runs.size() == 1 ? cards(runs[0]) : comparison(runs);
  return html + "</section>\n";
}

std::string summary_section(const std::vector<ReportRun>& runs) {
  std::vector<MeasureGroup> groups = accuracy_groups();
  for (MeasureGroup& group : cost_groups()) groups.push_back(std::move(group));
  std::string names;
  for (std::size_t i = 0; i < runs.size() && runs.size() > 1; ++i) {
    names += fmt::format("<th scope=\"col\"><i style=\"background:var(--run{})\"></i>{}</th>", i % 8,
                         escape_html(runs[i].label));
  }
  std::string html = "<section><h2>All measures</h2>\n<div class=\"tables\">\n";
  for (const MeasureGroup& group : groups) {
    std::string rows;
    for (const Measure& measure : group.measures) rows += measure_row(measure, runs);
    if (rows.empty()) continue;
    html += fmt::format(
        "<div class=\"wide\"><table>\n<thead><tr><th "
        "class=\"group\">{}</th>{}</tr></thead>\n<tbody>{}</tbody></table>"
        "</div>\n",
        group.title, names.empty() ? "<th></th>" : names, rows);
  }
  return html + "</div>\n</section>\n";
}

}  // namespace surefield
