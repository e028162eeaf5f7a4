#pragma once

#include <optional>
#include <utility>

#include "engine/places/rigid_match.h"

namespace surefield {

/// The features of a frame, looked for when they are first asked for.
class FrameFeatures {
 public:
  /// Both outlive it.
  FrameFeatures(const Frame& frame, const Intrinsics& intrinsics) : frame_(frame), intrinsics_(intrinsics) {}

  const PlacedFeatures& get() {
    if (!found_) found_ = place_features(frame_, intrinsics_);
    return *found_;
  }

 private:
  const Frame& frame_;
  const Intrinsics& intrinsics_;
  std::optional<PlacedFeatures> found_;
};

}  // namespace surefield
