#include "engine/viewer/scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

constexpr double kSlack = 1e-9;  // relative: what is a multiple but for rounding counts as one

/// The smallest of 1, 2 and 5 times a power of ten that is not below `least`.
double round_above(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - kSlack)) return factor * power;
  return 10 * power;
}

/// A number to three digits, without zeros that say nothing.
std::string three_digits(double value) {
  const double size = std::abs(value);
  const int digits = size < 9.995 ? 2 : size < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}", value, digits);
}

}  // namespace

double round_below(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (double factor : {10.0, 5.0, 2.0})
    if (factor * power <= most * (1 + kSlack)) return factor * power;
  return power;
}

std::vector<double> ticks_between(double low, double high, int most) {
  std::vector<double> ticks;
  if (!(low < high)) return ticks;
  const auto index_after = [&](double step) { return std::ceil(low / step - kSlack); };
  const auto index_before = [&](double step) { return std::floor(high / step + kSlack); };
  double step = round_above((high - low) / most);
  while (index_before(step) - index_after(step) + 1 > most) step = round_above(1.5 * step);
  const double first = index_after(step) + 0.0;  // without the sign that a zero may have
  for (double i = first; i <= index_before(step); ++i) ticks.push_back(i * step);
  return ticks;
}

std::string format_length(double metres) {
  const double size = std::abs(metres);
  if (size < 0.009995) return three_digits(1000 * metres) + " mm";
  if (size < 0.9995) return three_digits(100 * metres) + " cm";
  return three_digits(metres) + " m";
}

std::string format_round_length(double metres) {
  if (metres < 0.009995) return fmt::format("{:g} mm", 1000 * metres);
  if (metres < 0.9995) return fmt::format("{:g} cm", 100 * metres);
  return fmt::format("{:g} m", metres);
}

std::string format_time(double seconds) {
  if (seconds < 59.995) return fmt::format("{:.2f} s", seconds);
  const auto tenths = std::llround(10 * seconds);
  if (tenths < 36000) return fmt::format("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10);
  const auto whole = std::llround(seconds);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace surefield
