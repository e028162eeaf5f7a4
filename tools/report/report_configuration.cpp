// Settings of the runs of a report.
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <map>
#include <set>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/report/html.h"
#include "engine/types/error.h"
#include "tools/report/report_sections.h"
#include "tools/results/run_configuration.h"

namespace surefield {

namespace {

constexpr std::size_t kNamedSettings = 12;  // more would fill the top of the page; all stand below

using Settings = std::map<std::string, std::string>;

/// Adds the values below a YAML node by their dotted keys.
void flatten(const YAML::Node& node, const std::string& key, Settings& settings) {
  if (!node.IsMap()) {
    settings[key] = node.IsScalar() ? node.Scalar() : YAML::Dump(node);
    return;
  }
  for (const auto& entry : node) {
    flatten(entry.second, key.empty() ? entry.first.Scalar() : key + "." + entry.first.Scalar(), settings);
  }
}

Settings configuration_of(const ReportRun& run) {
  Settings settings;
  try {
    flatten(YAML::Load(run.folder.configuration), "", settings);
  } catch (const YAML::Exception&) {
    throw InputError(run.folder.path / "config.yaml", "is no YAML");
  }
  return settings;
}

/// Whether two values are the same, as numbers where they are numbers.
bool same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const auto x = parse_numbers(a), y = parse_numbers(b);
  return x && y && *x == *y;
}

/// The settings of a run, with what the command line said of its frames.
Settings settings_of(const ReportRun& run) {
  Settings settings = configuration_of(run);
  for (const char* key : {"start", "stride", "scale"}) {
    const double value = run.folder.number(std::string("/dataset/") + key);
    settings[std::string("--") + key] = std::isnan(value) ? "–" : fmt::format("{:g}", value);
  }
  settings["device"] = run.folder.text("/device/name");
  settings["commit"] = run.folder.text("/program/commit");
  return settings;
}

/// The settings in which the runs differ, one a line.
std::string differences(const std::vector<ReportRun>& runs) {
  std::vector<Settings> all;
  std::set<std::string> keys;
  for (const ReportRun& run : runs) {
    all.push_back(settings_of(run));
    for (const auto& entry : all.back()) keys.insert(entry.first);
  }
  std::string rows;
  for (const std::string& key : keys) {
    std::set<std::string> values;
    std::string cells;
    for (const Settings& settings : all) {
      const auto entry = settings.find(key);
      const std::string value = entry == settings.end() ? "–" : entry->second;
      values.insert(value);
      cells += "<td>" + escape_html(value) + "</td>";
    }
    if (values.size() > 1) rows += "<tr><th>" + escape_html(key) + "</th>" + cells + "</tr>\n";
  }
  if (rows.empty()) return "<p>All runs had the same settings.</p>\n";
  std::string head = "<tr><th></th>";
  for (const ReportRun& run : runs) head += "<th scope=\"col\">" + escape_html(run.label) + "</th>";
  return "<div class=\"wide\"><table>\n<thead>" + head + "</tr></thead>\n<tbody>" + rows +
         "</tbody></table></div>\n";
}

}  // namespace

std::string seed_of(const ReportRun& run) {
  const Settings settings = configuration_of(run);
  const auto seed = settings.find("seed");
  return seed == settings.end() ? "unknown" : seed->second;
}

std::string changed_settings(const ReportRun& run) {
  SlamSettings unused;
  Settings defaults;
  flatten(YAML::Load(load_settings(unused, {}, run.folder.text("/dataset/format"))), "", defaults);
  std::string text;
  std::size_t changed = 0;
  for (const auto& [key, value] : configuration_of(run)) {
    const auto usual = defaults.find(key);
    if (key == "seed" || (usual != defaults.end() && same_value(value, usual->second))) continue;
    if (++changed > kNamedSettings) continue;
    text += (text.empty() ? "" : ", ") + key + " = " + value;
  }
  if (changed > kNamedSettings) text += fmt::format(" and {} more", changed - kNamedSettings);
  return text;
}

std::string configuration_section(const std::vector<ReportRun>& runs) {
  std::string html = "<section><h2>Configuration</h2>\n";
  if (runs.size() > 1) html += differences(runs);
  for (const ReportRun& run : runs) {
    html += fmt::format("<details><summary>All settings{}</summary><pre>{}</pre></details>\n",
                        runs.size() > 1 ? " of " + escape_html(run.label) : "",
                        escape_html(run.folder.configuration));
  }
  return html + "</section>\n";
}

}  // namespace surefield
