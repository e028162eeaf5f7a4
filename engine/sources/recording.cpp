#include "engine/sources/recording.h"

#include <utility>

namespace surefield {

std::optional<Frame> Recording::next() {
  while (next_ < count()) {
    const int index = next_++;
    LoadedFrame loaded = load(index);
    if (loaded.frame) return std::move(loaded.frame);
    problems_.push_back({index, std::move(loaded.problem)});
  }
  return std::nullopt;
}

}  // namespace surefield
