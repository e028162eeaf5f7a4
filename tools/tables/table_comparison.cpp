#include "tools/tables/table_comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

constexpr const char* kNoValue = "-";

/// A column: a metric in one scene, or its mean over several.
struct ComparisonColumn {
  std::string name;
  const TableMetric* metric = nullptr;
  std::vector<std::string> scenes;
};

/// How a variant compares in one column.
enum class Verdict { Unknown, Tie, Better, Worse };

/// Unknown where a value is missing, or has no spread since there is one seed alone. A difference is within
/// the spread where it is no larger than the root of both variances: the standard deviation of the difference
/// between one run of each.
Verdict judge(const TableMetric& metric, const std::optional<Spread>& value,
              const std::optional<Spread>& baseline) {
  if (!value || !baseline || !value->deviation || !baseline->deviation) return Verdict::Unknown;
  const double difference = value->mean - baseline->mean;
  if (std::abs(difference) <= std::hypot(*value->deviation, *baseline->deviation)) return Verdict::Tie;
  return (difference > 0) == metric.larger_is_better ? Verdict::Better : Verdict::Worse;
}

std::vector<ComparisonColumn> columns_of(const TableSpec& spec, const std::vector<std::string>& scenes) {
  std::vector<ComparisonColumn> columns;
  for (const TableMetric& metric : spec.metrics) columns.push_back({metric.name, &metric, scenes});
  for (const std::string& scene : scenes)
    columns.push_back({spec.metrics.front().name + ", " + scene, &spec.metrics.front(), {scene}});
  return columns;
}

/// One line: the variants with this verdict on the mean of a metric.
std::string verdict_line(const TableSpec& spec, const OwnResults& results, const TableVariant& baseline,
                         const std::vector<std::string>& scenes, Verdict verdict) {
  std::vector<std::string> names;
  for (const TableVariant& variant : spec.variants) {
    std::vector<std::string> metrics;
    for (const TableMetric& metric : spec.metrics) {
      const auto value = results.mean(variant, metric, scenes);
      if (judge(metric, value, results.mean(baseline, metric, scenes)) == verdict)
        metrics.push_back(metric.name);
    }
    if (!metrics.empty()) names.push_back(fmt::format("{} ({})", variant.name, fmt::join(metrics, ", ")));
  }
  return fmt::format("{} than {} beyond the spread: {}.\n", verdict == Verdict::Better ? "Better" : "Worse",
                     baseline.name, names.empty() ? "none" : fmt::format("{}", fmt::join(names, "; ")));
}

/// What the differences come to.
std::string verdict_lines(const TableSpec& spec, const OwnResults& results, const TableVariant& baseline,
                          const std::vector<std::string>& scenes) {
  const auto value = results.mean(baseline, spec.metrics.front(), scenes);
  if (!value || !value->deviation)
    return "One seed does not tell a difference from chance: run all scenes with --seeds 3.\n";
  return fmt::format("≈: no farther from {} than the spread over seeds.\n", baseline.name) +
         verdict_line(spec, results, baseline, scenes, Verdict::Better) +
         verdict_line(spec, results, baseline, scenes, Verdict::Worse);
}

std::string cell(const ComparisonColumn& column, const OwnResults& results, const TableVariant& variant,
                 const TableVariant& baseline) {
  const auto value = results.mean(variant, *column.metric, column.scenes);
  if (!value) return kNoValue;
  const std::string text = value->text(column.metric->decimals);
  if (&variant == &baseline) return text;
  const Verdict verdict = judge(*column.metric, value, results.mean(baseline, *column.metric, column.scenes));
  return (verdict == Verdict::Tie ? "≈ " : "") + text;
}

}  // namespace

std::string comparison_markdown(const TableSpec& spec, const OwnResults& results) {
  const TableVariant& baseline =
      *std::find_if(spec.variants.begin(), spec.variants.end(),
                    [&](const TableVariant& variant) { return variant.folder == spec.compared_with; });
  std::vector<std::string> scenes = spec.scenes;
  std::erase_if(scenes, [&](const std::string& scene) {
    return !results.value(baseline, spec.metrics.front(), scene);
  });
  if (scenes.empty()) return "";
  const std::vector<ComparisonColumn> columns = columns_of(spec, scenes);
  std::string text =
      fmt::format("## {}\n\nMean over {}.\n\n| variant |", spec.title, fmt::join(scenes, ", "));
  std::string rule = "|---|";
  for (const ComparisonColumn& column : columns) {
    text += fmt::format(" {} |", column.name);
    rule += "--:|";
  }
  text += "\n" + rule + "\n";
  for (const TableVariant& variant : spec.variants) {
    text += fmt::format("| **{}** |", variant.name);
    for (const ComparisonColumn& column : columns)
      text += fmt::format(" {} |", cell(column, results, variant, baseline));
    text += "\n";
  }
  return text + "\n" + verdict_lines(spec, results, baseline, scenes);
}

}  // namespace surefield
