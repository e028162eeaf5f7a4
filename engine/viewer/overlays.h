#pragma once

#include "engine/types/trajectory.h"
#include "engine/viewer/line_overlay.h"

namespace surefield {

/// How a set of overlay lines looks.
struct LineStyle {
  Eigen::Vector4f colour = Eigen::Vector4f::Ones();  ///< RGB and opacity, 0 to 1
  float width = 2;                                   ///< pixels
  bool on_top = false;                               ///< also in front of the map that hides it
};

/// Adds the path of a camera, from pose to pose; a pose that is not finite interrupts it.
void add_path(std::vector<Line>& lines, const Trajectory& trajectory, const LineStyle& style);

/// Adds a camera as the pyramid of what it sees, `length` metres long.
void add_frustum(std::vector<Line>& lines, const Camera& camera, double length, const LineStyle& style);

/// Adds a straight link between two places (metres).
void add_link(std::vector<Line>& lines, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              const LineStyle& style);

}  // namespace surefield
