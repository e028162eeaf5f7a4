#pragma once

#include "engine/types/trajectory.h"

namespace surefield {

/// The frames of a recorded trajectory in seconds since the first: their stamps are what a person knows of a
/// recording. Keeps no copy of the trajectory, which outlives it; stamps do not fall.
class Timeline {
 public:
  explicit Timeline(const Trajectory& trajectory) : trajectory_(trajectory) {}

  /// Of the last frame; 0 where there are none.
  double duration() const;
  /// Of the frame at a position, which is brought between the first and the last.
  double seconds_at(int position) const;
  /// The last position whose frame is not later than that; the first one before there is any.
  int position_at(double seconds) const;

 private:
  const Trajectory& trajectory_;
};

/// Playback of a timeline at the speed at which it was recorded.
struct Playback {
  double seconds = 0;  ///< since the first frame

  /// Goes on by so much, from the beginning again after the end, and returns the position that is reached.
  /// `position` is the frame that is shown: where somebody has chosen another one, playback goes on from
  /// there.
  int advance(const Timeline& timeline, int position, double by);
};

}  // namespace surefield
