#include "engine/slam/depth_agreement.h"

#include <algorithm>
#include <cmath>

#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr double kSame = 0.05;      // metres of difference that are none, at least
constexpr double kSameSigmas = 3;   // deviations of the sensor

/// Calls visit(point in the camera's frame) for every cell with depth.
template <typename Visit>
void for_each_point(const DepthView& view, Visit visit) {
  const ColourGrid& grid = view.grid;
  const Intrinsics& k = view.camera.intrinsics;
  const int half = grid.cell / 2;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const double z = grid.depth[static_cast<std::size_t>(y) * grid.width + x];
      if (z > 0)
        visit(Eigen::Vector3d(z * (x * grid.cell + half - k.cx) / k.fx, z * (y * grid.cell + half - k.cy) / k.fy, z));
    }
}

/// The least and the largest depth of the four cells around a pixel.
struct DepthRange {
  bool inside = false;   ///< all four are cells of the image
  bool measured = false; ///< and have depth
  double least = 0, largest = 0;
};

DepthRange range_around(const ColourGrid& grid, double u, double v) {
  const int half = grid.cell / 2;
  const double x = std::floor((u - half) / grid.cell), y = std::floor((v - half) / grid.cell);
  if (!(x >= 0 && y >= 0 && x + 1 < grid.width && y + 1 < grid.height)) return {};
  const std::size_t at = static_cast<std::size_t>(y) * grid.width + static_cast<std::size_t>(x);
  const auto [least, largest] = std::minmax(
      {grid.depth[at], grid.depth[at + 1], grid.depth[at + grid.width], grid.depth[at + grid.width + 1]});
  return {true, least > 0, least, largest};
}

struct Counts {
  int all = 0, shared = 0, measured = 0, equal = 0, through = 0;
};

/// What `to` says of the points of `from`.
Counts count_cells(const DepthView& from, const DepthView& to, const DepthNoise& noise) {
  const Pose between = to.camera.world_to_camera * from.camera.world_to_camera.inverse();
  const Intrinsics& k = to.camera.intrinsics;
  Counts counts;
  for_each_point(from, [&](const Eigen::Vector3d& point) {
    ++counts.all;
    const Eigen::Vector3d p = between * point;
    if (p.z() <= 0) return;
    const DepthRange range = range_around(to.grid, k.fx * p.x() / p.z() + k.cx, k.fy * p.y() / p.z() + k.cy);
    if (!range.inside) return;
    ++counts.shared;
    if (!range.measured) return;
    ++counts.measured;
    const double same = std::max(kSame, kSameSigmas * noise.sigma(p.z()));
    if (p.z() < range.least - same)
      ++counts.through;
    else if (p.z() < range.largest + same)  // beyond that it is hidden there
      ++counts.equal;
  });
  return counts;
}

double share(int part, int all) {
  return all > 0 ? static_cast<double>(part) / all : 0;
}

}  // namespace

DepthAgreement compare_depth(const DepthView& one, const DepthView& other, const DepthNoise& noise) {
  const Counts there = count_cells(one, other, noise), back = count_cells(other, one, noise);
  return {.shared = std::max(share(there.shared, there.all), share(back.shared, back.all)),
          .agreeing = share(there.equal + back.equal, there.measured + back.measured),
          .seen_through = std::max(share(there.through, there.equal + there.through),
                                   share(back.through, back.equal + back.through))};
}

double median_shift(const DepthView& view, const Pose& corrected) {
  const Pose motion = corrected * view.camera.world_to_camera.inverse();
  const Intrinsics& k = view.camera.intrinsics;
  std::vector<double> shifts;
  for_each_point(view, [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d p = motion * point;
    const Eigen::Vector2d shift = p.z() > 0 ? (p.hnormalized() - point.hnormalized()).eval() : Eigen::Vector2d(1, 1);
    shifts.push_back(std::hypot(k.fx * shift.x(), k.fy * shift.y()));
  });
  return shifts.empty() ? 0 : median(shifts);
}

}  // namespace surefield
