#pragma once

#include <algorithm>
#include <vector>

namespace surefield {

/// The median (of an even number of values the upper one) of `values`, which must not be empty.
template <class T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace surefield
