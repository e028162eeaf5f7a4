#include "engine/session/kept_keyframes.h"

#include <algorithm>
#include <utility>

namespace surefield {

void KeptKeyframes::add(const Frame& keyframe) {
  if (added_++ % every_ != 0) return;
  frames_.push_back(keyframe);
  if (frames_.size() <= kMost) return;
  // One in two of those that are kept stays: the first, the third, and so on.
  std::vector<Frame> stay;
  for (std::size_t i = 0; i < frames_.size(); i += 2) stay.push_back(frames_[i]);
  frames_ = std::move(stay);
  every_ *= 2;
}

const Frame* KeptKeyframes::find(int index) const {
  const auto found =
      std::find_if(frames_.begin(), frames_.end(), [&](const Frame& frame) { return frame.index == index; });
  return found == frames_.end() ? nullptr : &*found;
}

}  // namespace surefield
