#include "engine/report/plot_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

double nice_step(double size, int count) {
  const double rough = size / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

std::string Ticks::label(double value) const {
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  const double shown = std::abs(value) < step * 1e-6 ? 0 : value;  // no "-0"
  return fmt::format("{:.{}f}", shown, decimals);
}

Ticks nice_ticks(const AxisRange& range, int count) {
  Ticks ticks{nice_step(range.size(), count), {}};
  const auto first = static_cast<int64_t>(std::ceil(range.low / ticks.step - 1e-6));
  const auto last = static_cast<int64_t>(std::floor(range.high / ticks.step + 1e-6));
  for (int64_t i = first; i <= last; ++i) ticks.values.push_back(static_cast<double>(i) * ticks.step);
  return ticks;
}

AxisRange grown_to_ticks(const AxisRange& range, int count) {
  const double step = nice_step(range.size(), count);
  return {std::floor(range.low / step + 1e-6) * step, std::ceil(range.high / step - 1e-6) * step};
}

}  // namespace surefield
