#pragma once

#include <functional>
#include <vector>

#include "engine/synth/scene.h"

namespace surefield {

/// A scene in which a chair has been moved, and from which frame on.
struct MovedChair {
  Scene scene;
  int object = 0;  ///< of the chair
  int frame = 0;
};

/// The share of an image that each object of the scene takes, as it is before the chair moves.
using VisibleShares = std::function<std::vector<double>(int frame)>;

/// Moves a chair by up to half a metre and 40 degrees while nobody looks: in the middle of the longest time
/// between two visits, of the chair of which that is the longest, with room to move. Throws InputError where
/// no chair is seen, then not for a second, and seen again within so many frames.
MovedChair move_chair(const Scene& scene, int frames, const VisibleShares& visible);

}  // namespace surefield
