#include "engine/viewer/axes_gizmo.h"

#include <algorithm>

namespace surefield {

std::array<AxisArm, 4> axes_seen(const Pose& camera_to_world, const Eigen::Vector3d& up) {
  const auto arm = [&](const char* name, const Eigen::Vector3d& axis, const Eigen::Vector3f& colour) {
    const Eigen::Vector3d seen = camera_to_world.linear().transpose() * axis;
    return AxisArm{name, seen.head<2>(), -seen.z(), colour};
  };
  std::array<AxisArm, 4> arms = {arm("x", Eigen::Vector3d::UnitX(), {0.95f, 0.3f, 0.3f}),
                                 arm("y", Eigen::Vector3d::UnitY(), {0.35f, 0.85f, 0.35f}),
                                 arm("z", Eigen::Vector3d::UnitZ(), {0.4f, 0.6f, 1.0f}),
                                 arm("up", up, {0.95f, 0.95f, 0.95f})};
  std::stable_sort(arms.begin(), arms.end(),
                   [](const AxisArm& a, const AxisArm& b) { return a.towards < b.towards; });
  return arms;
}

}  // namespace surefield
