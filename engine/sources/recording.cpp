#include "engine/sources/recording.h"

#include <cmath>
#include <utility>

namespace surefield {

namespace {

constexpr double kOneClock = 0.1;  // seconds that stamps of one frame may be apart

}  // namespace

double depth_after(double colour_stamp, double depth_stamp) {
  const double after = depth_stamp - colour_stamp;
  return std::abs(after) <= kOneClock ? after : 0;
}

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
