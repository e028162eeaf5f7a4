#pragma once

#include <functional>
#include <limits>

#include "engine/sources/recording.h"

namespace surefield {

/// When depth images were taken, by what they show. In seconds, or in frames where the stamps only number the
/// frames.
struct DepthDelay {
  double value = 0;  ///< to be added to the stamps of depth images, so that they say when those were taken
  double error = std::numeric_limits<double>::infinity();  ///< standard error; infinite: nothing is known
  double period = 0;                                       ///< median time between frames

  /// Whether the recording tells more than that it is somewhere within two frames.
  bool known() const { return error < 0.4 * period; }
  /// What to add to the stamps: the value as far as it is certain. Delays are thought to be about half a
  /// frame (the prior), which draws a value with a large error towards 0; one below two standard errors is
  /// none.
  double usable() const;
};

/// Whether depth images have stamps of their own.
bool has_depth_stamps(const Recording& recording);

/// Estimates when depth images were taken. Colour images from all over the recording are compared with the
/// depth images of up to three frames before and after: where colour and depth fit, colour edges are strong
/// at the depth edges, and the delay is where a bell through these strengths has its top, one for all. The
/// error is by how much the result changes when parts of the recording are left out. Needs no poses, but
/// motion. Loads up to some 140 frames; `go_on` is told how much is done, in [0, 1], and ends the work, with
/// nothing known, by returning false.
DepthDelay estimate_depth_delay(const Recording& recording, const std::function<bool(double)>& go_on = {});

}  // namespace surefield
