#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace surefield {

/// Seconds between the colour and the depth image of a frame, at the most.
inline constexpr double kMaxStampDifference = 0.02;

/// What of a sorted list of things with a `timestamp` is nearest in time; the earlier one of two at the same
/// distance. The list must not be empty.
template <typename Item>
const Item& nearest_in_time(const std::vector<Item>& items, double timestamp) {
  const auto after = std::lower_bound(items.begin(), items.end(), timestamp,
                                      [](const Item& item, double stamp) { return item.timestamp < stamp; });
  if (after == items.begin()) return *after;
  const auto before = std::prev(after);
  if (after == items.end()) return *before;
  return timestamp - before->timestamp <= after->timestamp - timestamp ? *before : *after;
}

/// Calls `found(colour, depth)` for each colour image that has a depth image within kMaxStampDifference, with
/// the nearest; returns how many have none. Both lists are sorted and not empty.
template <typename Item, typename Found>
std::size_t pair_by_time(const std::vector<Item>& colours, const std::vector<Item>& depths, Found found) {
  std::size_t lonely = 0;
  for (const Item& colour : colours) {
    const Item& depth = nearest_in_time(depths, colour.timestamp);
    if (std::abs(depth.timestamp - colour.timestamp) > kMaxStampDifference) {
      ++lonely;
    } else {
      found(colour, depth);
    }
  }
  return lonely;
}

}  // namespace surefield
