#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "engine/io/text_file.h"
#include "engine/sources/file_recording.h"
#include "engine/types/error.h"

namespace surefield {

/// Sorts what has a `timestamp`; what has the same one keeps its order.
template <typename Item>
void sort_by_time(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.timestamp < b.timestamp; });
}

/// The rows of a list, each read by `parse(line)` into something with a `timestamp`, in the order of those;
/// where the list has another order, that is a warning of the sequence. Throws InputError where the list is
/// empty, or `parse` does.
template <typename Parse>
auto read_stamped_rows(const std::filesystem::path& file, StoredSequence& sequence, Parse parse) {
  std::vector<decltype(parse(TextLine{}))> items;
  bool told = false;
  for (const TextLine& line : read_rows(file)) {
    auto item = parse(line);
    if (!told && !items.empty() && item.timestamp < items.back().timestamp) {
      sequence.warnings.push_back(fmt::format(
          "{}:{}: the time goes back; the images are sorted by their stamps", file.string(), line.number));
      told = true;
    }
    items.push_back(std::move(item));
  }
  if (items.empty()) throw InputError(file, "lists no image");
  sort_by_time(items);
  return items;
}

}  // namespace surefield
