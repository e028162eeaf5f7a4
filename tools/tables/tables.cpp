// surefield tables: what tools/reproduce has run, as Markdown beside published results.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "engine/io/files.h"
#include "engine/types/error.h"
#include "tools/shared/command.h"
#include "tools/tables/table_comparison.h"
#include "tools/tables/table_results.h"

namespace surefield {

namespace {

constexpr const char* kTablesExamples =
    "tools/reproduce makes the runs and calls this; by itself it only writes their tables anew.\n"
    "Runs are looked for in RUNS/SET/SCENE/VARIANT/seedN. Values are means over seeds, with the standard "
    "deviation\n"
    "where there are several; a mean over scenes is given only where every scene was run.\n"
    "\n"
    "Example:\n"
    "  surefield tables --runs out/reproduce/runs --published tools/published.csv --out tables.md\n";

constexpr const char* kNothing = "-";
constexpr const char* kMeanColumn = "mean";

struct TableOptions {
  std::string runs;
  std::string published;
  std::string out;
  std::vector<std::string> tables;  ///< empty: all
};

/// A row of a Markdown table.
struct TableRow {
  std::string method;
  std::string metric;
  std::vector<std::string> cells;
};

/// A cell of an own row.
std::string cell(const OwnResults& results, const TableVariant& variant, const TableMetric& metric,
                 const std::string& scene) {
  const auto value = results.value(variant, metric, scene);
  if (!value) return kNothing;
  if (!metric.times) return value->text(metric.decimals);
  const auto count = results.count(variant, metric, scene);
  return fmt::format("{:.{}f} x {:.0f}", value->mean, metric.decimals, count ? count->mean : 0);
}

/// The same over all scenes.
std::string mean_cell(const OwnResults& results, const TableVariant& variant, const TableMetric& metric,
                      const std::vector<std::string>& scenes) {
  if (scenes.size() == 1) return cell(results, variant, metric, scenes.front());
  const auto mean = results.mean(variant, metric, scenes);
  return mean ? mean->text(metric.decimals) : kNothing;
}

std::vector<std::string> columns_of(const TableSpec& spec) {
  std::vector<std::string> columns;
  if (spec.metrics_as_columns) {
    for (const TableMetric& metric : spec.metrics) columns.push_back(metric.name);
  } else {
    columns = spec.scenes;
    columns.push_back(kMeanColumn);
  }
  return columns;
}

/// Rows of published values, in the order of the file. Where metrics are columns, so they are there.
std::vector<TableRow> published_rows(const TableSpec& spec, const std::vector<PublishedValue>& published) {
  const std::vector<std::string> columns = columns_of(spec);
  std::vector<TableRow> rows;
  for (const PublishedValue& value : published) {
    if (value.table != spec.id) continue;
    const bool by_metric = spec.metrics_as_columns && value.column == kMeanColumn;
    const std::string& column_name = by_metric ? value.metric : value.column;
    const std::string metric = spec.metrics_as_columns ? "" : value.metric;
    const auto column = std::find(columns.begin(), columns.end(), column_name);
    if (column == columns.end()) continue;
    auto row = std::find_if(rows.begin(), rows.end(), [&](const TableRow& each) {
      return each.method == value.method && each.metric == metric;
    });
    if (row == rows.end()) {
      row =
          rows.insert(rows.end(), {value.method, metric, std::vector<std::string>(columns.size(), kNothing)});
    }
    row->cells[static_cast<std::size_t>(column - columns.begin())] = value.value;
  }
  return rows;
}

std::vector<TableRow> own_rows(const TableSpec& spec, const OwnResults& results) {
  std::vector<TableRow> rows;
  for (const TableVariant& variant : spec.variants) {
    const std::string name = "**" + variant.name + "**";
    if (spec.metrics_as_columns) {
      rows.push_back({name, "", {}});
      for (const TableMetric& metric : spec.metrics)
        rows.back().cells.push_back(mean_cell(results, variant, metric, spec.scenes));
      continue;
    }
    for (const TableMetric& metric : spec.metrics) {
      rows.push_back({name, metric.name, {}});
      for (const std::string& scene : spec.scenes)
        rows.back().cells.push_back(cell(results, variant, metric, scene));
      rows.back().cells.push_back(mean_cell(results, variant, metric, spec.scenes));
    }
  }
  return rows;
}

bool has_value(const TableRow& row) {
  return std::any_of(row.cells.begin(), row.cells.end(),
                     [](const std::string& cell) { return cell != kNothing; });
}

/// How many frames the runs had, so that a part of a sequence is not taken for the whole.
std::string frames_line(const TableSpec& spec, const ReproducedRuns& runs) {
  std::vector<double> counts;
  for (const TableVariant& variant : spec.variants) {
    for (const std::string& scene : spec.scenes) {
      const std::string place = spec.set + "/" + scene + "/" + variant.folder;
      for (const auto& entry : runs.numbers(place, {"metrics.json", "/frames/fed"}))
        counts.push_back(entry.second);
    }
  }
  if (counts.empty()) return "";
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
  if (*least == *most) return fmt::format("- Surefield: {} frames a run\n", *least);
  return fmt::format("- Surefield: {} to {} frames a run\n", *least, *most);
}

/// What made the runs, each line once.
std::string origin_lines(const TableSpec& spec, const ReproducedRuns& runs) {
  std::vector<std::string> lines;
  for (const TableVariant& variant : spec.variants) {
    for (const std::string& scene : spec.scenes) {
      for (const std::string& line : runs.origins(spec.set + "/" + scene + "/" + variant.folder)) {
        if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
      }
    }
  }
  std::string text;
  for (const std::string& line : lines) text += "- Surefield: " + line + "\n";
  return text + frames_line(spec, runs);
}

std::string source_lines(const TableSpec& spec, const std::vector<PublishedValue>& published) {
  std::set<std::string> sources;
  for (const PublishedValue& value : published) {
    if (value.table == spec.id) sources.insert(value.source);
  }
  std::string text;
  for (const std::string& source : sources) text += "- Published: " + source + "\n";
  return text;
}

/// A table with its heading; empty where nothing was run for it.
std::string table_markdown(const TableSpec& spec, const ReproducedRuns& runs,
                           const std::vector<PublishedValue>& published) {
  const OwnResults results(runs, spec.set);
  if (!spec.compared_with.empty()) {
    const std::string text = comparison_markdown(spec, results);
    return text.empty() ? "" : text + "\n" + origin_lines(spec, runs) + "\n";
  }
  const std::vector<TableRow> own = own_rows(spec, results);
  if (std::none_of(own.begin(), own.end(), has_value)) return "";
  std::vector<TableRow> rows = published_rows(spec, published);
  rows.insert(rows.end(), own.begin(), own.end());
  const bool names_metrics = !spec.metrics_as_columns && spec.metrics.size() > 1;
  std::string text = fmt::format("## {}\n\n", spec.title);
  if (!spec.metrics_as_columns && spec.metrics.size() == 1) text += spec.metrics.front().name + "\n\n";
  text += names_metrics ? "| method | metric |" : "| method |";
  std::string rule = names_metrics ? "|---|---|" : "|---|";
  for (const std::string& column : columns_of(spec)) {
    text += fmt::format(" {} |", column);
    rule += "--:|";
  }
  text += "\n" + rule + "\n";
  for (const TableRow& row : rows) {
    text += fmt::format("| {} |", row.method) + (names_metrics ? fmt::format(" {} |", row.metric) : "");
    for (const std::string& cell : row.cells) text += fmt::format(" {} |", cell);
    text += "\n";
  }
  return text + "\n" + origin_lines(spec, runs) + source_lines(spec, published) + "\n";
}

void check_tables(const std::vector<std::string>& wanted) {
  for (const std::string& id : wanted) {
    const auto& specs = table_specs();
    if (std::any_of(specs.begin(), specs.end(), [&](const TableSpec& spec) { return spec.id == id; }))
      continue;
    std::string known;
    for (const TableSpec& spec : specs) known += (known.empty() ? "" : ", ") + spec.id;
    throw InputError("there is no table " + id + "; there are " + known);
  }
}

int write_tables(const TableOptions& options) {
  check_tables(options.tables);
  const std::vector<PublishedValue> published = read_published(options.published);
  const ReproducedRuns runs(options.runs);
  std::string text =
      "# Reproduced tables\n\nMeans over seeds, ± standard deviation. A dash: not run, or not published.\n\n";
  for (const TableSpec& spec : table_specs()) {
    const auto& wanted = options.tables;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), spec.id) == wanted.end()) continue;
    text += table_markdown(spec, runs, published);
  }
  write_file(options.out, [&](std::ostream& stream) { stream << text; });
  return kSuccess;
}

}  // namespace

void add_tables(CLI::App& program, Action& action) {
  auto options = std::make_shared<TableOptions>();
  CLI::App* tables = program.add_subcommand("tables", "Writes reproduced results beside published ones");
  tables->add_option("tables", options->tables, "Names of tables; default: all")->type_name("TABLE");
  tables->add_option("--runs", options->runs, "Folder of the runs")->required();
  tables->add_option("--published", options->published, "CSV file of published values")->required();
  tables->add_option("--out", options->out, "Markdown file to write")->required();
  tables->footer(kTablesExamples);
  tables->callback([options, &action] { action = [options] { return write_tables(*options); }; });
}

}  // namespace surefield
