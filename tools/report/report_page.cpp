#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <set>

#include "engine/report/html.h"
#include "engine/types/build_info.h"
#include "engine/types/version.h"
#include "tools/report/report_sections.h"

namespace surefield {

namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --page:#fff; --panel:#f5f6f8; --text:#1c2128; --muted:#5b6572; --border:#d8dde3;
  --grid:#e7eaee; --reference:#9aa4b1; --good:#1a7f4b; --fair:#9a5b00; --bad:#c62828;
  --run0:#2463d6; --run1:#d9480f; --run2:#0b8a7d; --run3:#9333c9; --run4:#b58100; --run5:#d0246f; --run6:#4d7c0f;
  --run7:#5a6b80; --part0:#2463d6; --part1:#e08a3c; --part2:#b9c1cc; --part3:#7a8798; }
@media screen and (prefers-color-scheme: dark) {
  :root { --page:#14171c; --panel:#1d2229; --text:#e4e8ee; --muted:#9aa6b4; --border:#343c47; --grid:#2a313a;
    --reference:#7d8999; --good:#4cc38a; --fair:#e2a336; --bad:#ff6b6b;
    --run0:#6ea8ff; --run1:#ff9a5c; --run2:#4fd1c0; --run3:#c893ff; --run4:#ecc94b; --run5:#ff7eb6; --run6:#a5d977;
    --run7:#a9b8ca; --part0:#6ea8ff; --part1:#ff9a5c; --part2:#566170; --part3:#8a97a8; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 28px 32px 48px; max-width: 1240px; background: var(--page); color: var(--text);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 27px; line-height: 1.25; overflow-wrap: anywhere; }
h2 { margin: 36px 0 10px; padding-bottom: 5px; border-bottom: 1px solid var(--border); font-size: 19px; }
h3 { margin: 22px 0 4px; font-size: 15px; }
small, .note, .meta, footer { color: var(--muted); font-size: 13px; }
.meta { margin: 4px 0 20px; }
.verdict { margin: 8px 0; padding: 10px 14px; border-left: 5px solid var(--level); background: var(--panel);
  border-radius: 4px; }
.verdict > b { display: inline-block; margin-right: 8px; padding: 0 9px; border-radius: 10px; background: var(--level);
  color: var(--page); font-size: 13px; text-transform: uppercase; letter-spacing: .04em; cursor: help; }
.good { --level: var(--good); } .fair { --level: var(--fair); } .bad { --level: var(--bad); }
.verdict i, th i, .legend i { display: inline-block; width: 11px; height: 11px; margin-right: 6px; border-radius: 3px; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(210px, 1fr)); gap: 12px; margin-top: 14px; }
.card { display: flex; flex-direction: column; padding: 12px 16px; background: var(--panel); border-radius: 6px; }
.card span { color: var(--muted); font-size: 13px; } .card b { font-size: 26px; line-height: 1.35; font-weight: 650; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
td, th { padding: 3px 18px 3px 0; text-align: right; font-weight: 400; white-space: nowrap; }
tbody th { text-align: left; padding-right: 32px; } thead th { vertical-align: bottom; font-weight: 650; }
thead small { display: block; font-weight: 400; }
.tables { display: flex; flex-wrap: wrap; gap: 22px 64px; } .group { text-align: left; }
table.runs { margin-top: 14px; } table.runs thead th:nth-child(-n+2) { text-align: left; }
tbody tr:hover { background: var(--panel); } .best { font-weight: 700; color: var(--good); }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 460px), 1fr)); gap: 20px 28px; }
figure { margin: 0; min-width: 0; break-inside: avoid; } figcaption { font-weight: 600; font-size: 14px; }
.legend { display: flex; flex-wrap: wrap; gap: 2px 16px; color: var(--muted); font-size: 13px; }
svg { display: block; width: 100%; height: auto; overflow: visible; }
svg text { fill: var(--muted); font-size: 11px; font-variant-numeric: tabular-nums; }
svg .label { fill: var(--text); font-size: 11.5px; }
.grid { stroke: var(--grid); fill: none; } .axis { stroke: var(--muted); fill: none; }
.series { fill: none; stroke-width: 1.6; stroke-linejoin: round; } .start { fill: var(--page); stroke-width: 2; }
.reference { fill: none; stroke-width: 4; stroke-linejoin: round; opacity: .6; }
.hints circle { fill: transparent; } .hints circle:hover { fill: var(--text); fill-opacity: .35; }
.mark { fill: var(--bad); stroke: var(--page); }
.stages { margin-top: 20px; }
.bar { display: grid; grid-template-columns: minmax(60px, max-content) 1fr 90px; gap: 12px; align-items: center;
  margin-top: 6px; font-size: 13px; }
.bar b { font-weight: 500; max-width: 220px; overflow-wrap: anywhere; } .bar span { display: flex; height: 18px; }
.bar em { font-style: normal; text-align: right; font-variant-numeric: tabular-nums; }
.bar i { display: block; height: 100%; }
.images { display: grid; grid-template-columns: repeat(var(--columns), minmax(190px, 480px)); gap: 10px; }
.images img { display: block; width: 100%; height: auto; border-radius: 3px; }
.images figcaption { font-weight: 400; font-size: 13px; color: var(--muted); }
.scales { display: flex; flex-wrap: wrap; gap: 4px 28px; margin: 0 0 8px; font-size: 13px; color: var(--muted); }
.scale img { width: 110px; height: 9px; vertical-align: middle; border-radius: 2px; }
details { margin-top: 8px; } summary { cursor: pointer; }
pre { padding: 14px 18px; background: var(--panel); border-radius: 6px; overflow-x: auto; font-size: 12.5px;
  line-height: 1.45; }
footer { margin-top: 40px; padding-top: 10px; border-top: 1px solid var(--border); }
@media print { @page { margin: 14mm; } body { padding: 0; max-width: none; font-size: 12px;
    print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  .figures { grid-template-columns: 1fr 1fr; } .wide { overflow: visible; } h2, h3 { break-after: avoid; }
  .images { grid-template-columns: repeat(var(--columns), 1fr); } .cards { grid-template-columns: repeat(4, 1fr); }
  .frame, table { break-inside: avoid; } .card b { font-size: 19px; }
  details::details-content { content-visibility: visible; } pre { font-size: 9.5px; white-space: pre-wrap; } }
)css";

/// The values that the runs have, each once, in their order.
std::string distinct(const std::vector<ReportRun>& runs,
                     const std::function<std::string(const ReportRun&)>& value) {
  std::set<std::string> seen;
  std::string text;
  for (const ReportRun& run : runs) {
    const std::string each = value(run);
    if (!seen.insert(each).second) continue;
    text += (text.empty() ? "" : ", ") + each;
  }
  return text;
}

std::string heading(const std::vector<ReportRun>& runs) {
  if (runs.size() == 1) return runs[0].label;
  return fmt::format("{} runs", runs.size());
}

/// When a run was saved; where an older one does not say, when its file was written.
std::string date_of(const ReportRun& run) {
  if (const std::string date = run.folder.text("/date"); !date.empty()) return date;
  std::error_code error;
  const auto written = std::filesystem::last_write_time(run.folder.path / "metrics.json", error);
  if (error) return "date unknown";
  const auto seconds = std::chrono::floor<std::chrono::seconds>(std::chrono::file_clock::to_sys(written));
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
}

/// What makes a run another one than its neighbours: seed, date, settings.
std::string origin_line(const ReportRun& run, const std::string& label) {
  const std::string changed = changed_settings(run);
  return fmt::format(
      "<p class=\"meta\">{}seed {}, {}; {}</p>\n", escape_html(label), escape_html(seed_of(run)),
      escape_html(date_of(run)),
      escape_html(changed.empty() ? "all settings are the defaults" : "other than the defaults: " + changed));
}

std::string header(const std::vector<ReportRun>& runs) {
  const auto text = [&](const char* pointer) {
    return distinct(runs, [&](const ReportRun& run) { return run.folder.text(pointer); });
  };
  const std::string sizes = distinct(runs, [](const ReportRun& run) {
    return fmt::format("{:.0f} × {:.0f}", run.folder.number("/dataset/width"),
                       run.folder.number("/dataset/height"));
  });
  std::string html = fmt::format(
      "<header><h1>{}</h1><p class=\"meta\">Surefield run on {} ({}), {} pixels, {}</p>\n",
      escape_html(heading(runs)), escape_html(text("/dataset/name")), escape_html(text("/dataset/format")),
      escape_html(sizes), escape_html(text("/device/name")));
  for (const ReportRun& run : runs) html += origin_line(run, runs.size() > 1 ? run.label + ": " : "");
  return html + "</header>\n";
}

}  // namespace

std::string report_page(const std::vector<ReportRun>& runs, const ImageOptions& options) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n"
      "</head>\n<body>\n",
      escape_html("Surefield: " + heading(runs)), kStyle);
  html += header(runs) + verdict_section(runs) + trajectory_section(runs) + loop_section(runs);
  html += progress_section(runs) + image_section(runs, options);
  html += summary_section(runs) + configuration_section(runs);
  html +=
      fmt::format("<footer>Made by surefield {} ({}). Measures are defined in docs/evaluation.md.</footer>\n",
                  kVersion, kGitCommit);
  return html + "</body>\n</html>\n";
}

}  // namespace surefield
