#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace surefield::testing {

/// Largest |a - b| over the entries, relative to `scale` (an absolute size that the values naturally have).
template <class A, class B>
double largest_difference(const A& a, const B& b, double scale) {
  REQUIRE(a.size() == b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])) / scale;
    worst = std::isnan(difference) ? INFINITY : std::max(worst, difference);
  }
  return worst;
}

/// Largest |entry|, at least `floor`.
template <class A>
double magnitude(const A& a, double floor = 1e-12) {
  double largest = floor;
  for (const auto& x : a) largest = std::max(largest, std::abs(static_cast<double>(x)));
  return largest;
}

}  // namespace surefield::testing
