#include "engine/viewer/overlays.h"

#include <array>

namespace surefield {

void add_link(std::vector<Line>& lines, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              const LineStyle& style) {
  lines.push_back({from.cast<float>(), to.cast<float>(), style.colour, style.width, style.on_top});
}

void add_path(std::vector<Line>& lines, const Trajectory& trajectory, const LineStyle& style) {
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    if (trajectory[i - 1].is_finite() && trajectory[i].is_finite())
      add_link(lines, trajectory[i - 1].camera_to_world.translation(),
               trajectory[i].camera_to_world.translation(), style);
}

void add_frustum(std::vector<Line>& lines, const Camera& camera, double length, const LineStyle& style) {
  const Intrinsics& k = camera.intrinsics;
  const Pose camera_to_world = camera.world_to_camera.inverse();
  const Eigen::Vector3d apex = camera_to_world.translation();
  const auto corner = [&](double u, double v) -> Eigen::Vector3d {
    return camera_to_world * (length * Eigen::Vector3d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1));
  };
  const std::array<Eigen::Vector3d, 4> corners = {corner(-0.5, -0.5), corner(k.width - 0.5, -0.5),
                                                  corner(k.width - 0.5, k.height - 0.5),
                                                  corner(-0.5, k.height - 0.5)};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    add_link(lines, apex, corners[i], style);
    add_link(lines, corners[i], corners[(i + 1) % corners.size()], style);
  }
}

}  // namespace surefield
