#pragma once

#include <optional>
#include <string>

#include "engine/slam/colour_grid.h"

namespace surefield {

/// Tells the frames whose images cannot be used: those that show nothing, and, where a run begins with such,
/// those after them until the camera's exposure has settled.
class FirstLight {
 public:
  /// Why a frame is to be passed over; none where it may be used. `begun` says whether the map has been.
  std::optional<std::string> objection(const Frame& frame, const ColourGrid& grid, bool begun);

 private:
  bool blind_start_ = false;        ///< the run began with frames that show nothing
  int waited_ = 0;                  ///< frames that show something and were passed over
  std::optional<ColourGrid> last_;  ///< of those, the last one
};

}  // namespace surefield
