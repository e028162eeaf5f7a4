#pragma once

#include <algorithm>

namespace surefield {

/// How long one of many alike steps takes at present: a mean that forgets, since frames take longer as the
/// map grows, over enough steps that a keyframe among them changes little.
class RecentPace {
 public:
  void add(double seconds) {
    ++steps_;
    seconds_each_ += (seconds - seconds_each_) * std::max(1.0 / steps_, kNewestShare);
  }

  bool known() const { return steps_ > 0; }
  double seconds_each() const { return seconds_each_; }

 private:
  static constexpr double kNewestShare = 1.0 / 30;

  int steps_ = 0;
  double seconds_each_ = 0;
};

}  // namespace surefield
