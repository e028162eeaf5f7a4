#include "tools/tables/table_results.h"

namespace surefield {

namespace {

/// The numbers of one metric: value by value divided where the metric asks for it.
std::map<int, double> divided(const ReproducedRuns& runs, const std::string& place,
                              const NumberSource& source, const std::optional<NumberSource>& divisor) {
  std::map<int, double> numbers = runs.numbers(place, source);
  if (!divisor) return numbers;
  const std::map<int, double> divisors = runs.numbers(place, *divisor);
  std::erase_if(numbers, [&](const auto& entry) {
    const auto at = divisors.find(entry.first);
    return at == divisors.end() || at->second == 0;
  });
  for (auto& [seed, number] : numbers) number /= divisors.at(seed);
  return numbers;
}

std::vector<double> values_of(const std::map<int, double>& numbers) {
  std::vector<double> values;
  for (const auto& entry : numbers) values.push_back(entry.second);
  return values;
}

std::optional<NumberSource> value_divisor(const TableMetric& metric) {
  return metric.times ? std::nullopt : metric.divisor;
}

}  // namespace

std::optional<Spread> OwnResults::value(const TableVariant& variant, const TableMetric& metric,
                                        const std::string& scene) const {
  return spread_of(values_of(divided(runs_, place_of(variant, scene), metric.source, value_divisor(metric))));
}

std::optional<Spread> OwnResults::count(const TableVariant& variant, const TableMetric& metric,
                                        const std::string& scene) const {
  return spread_of(values_of(divided(runs_, place_of(variant, scene), *metric.times, metric.divisor)));
}

std::optional<Spread> OwnResults::mean(const TableVariant& variant, const TableMetric& metric,
                                       const std::vector<std::string>& scenes) const {
  std::map<int, double> sums;
  std::map<int, std::size_t> counts;
  for (const std::string& scene : scenes) {
    for (const auto& [seed, number] :
         divided(runs_, place_of(variant, scene), metric.source, value_divisor(metric))) {
      sums[seed] += number / static_cast<double>(scenes.size());
      ++counts[seed];
    }
  }
  std::erase_if(sums, [&](const auto& sum) { return counts[sum.first] < scenes.size(); });
  return spread_of(values_of(sums));
}

}  // namespace surefield
