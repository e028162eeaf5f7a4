#include "engine/slam/moved_things.h"

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

constexpr double kThrough = 0.1;      // metres that the other measured beyond, at least
constexpr double kDeviations = 4;     // of the sensor, at least
constexpr int kFewestNeighbours = 5;  // flagged cells of the eight around one
constexpr int kFewestCells = 6;       // of an image; fewer are none

/// The place of a cell's middle, pixels.
Eigen::Vector2d middle_of(const ColourGrid& grid, int x, int y) {
  const int half = grid.cell / 2;
  return {x * grid.cell + half, y * grid.cell + half};
}

/// The nearest depth of the four cells around a pixel; 0 where one of them has none, or lies outside.
double nearest_around(const ColourGrid& grid, double u, double v) {
  const int half = grid.cell / 2;
  const double x = std::floor((u - half) / grid.cell), y = std::floor((v - half) / grid.cell);
  if (!(x >= 0 && y >= 0 && x + 1 < grid.width && y + 1 < grid.height)) return 0;
  const std::size_t at = static_cast<std::size_t>(y) * grid.width + static_cast<std::size_t>(x);
  return std::min(
      {grid.depth[at], grid.depth[at + 1], grid.depth[at + grid.width], grid.depth[at + grid.width + 1]});
}

/// Whether the other keyframe looked through the point.
bool looks_through(const DepthView& other, const Eigen::Vector3d& world, const DepthNoise& noise) {
  const Eigen::Vector3d p = other.camera.world_to_camera * world;
  if (p.z() <= 0) return false;
  const Intrinsics& k = other.camera.intrinsics;
  const double beyond = nearest_around(other.grid, k.fx * p.x() / p.z() + k.cx, k.fy * p.y() / p.z() + k.cy);
  return beyond - p.z() > std::max(kThrough, kDeviations * noise.sigma(beyond));
}

int flagged_around(const std::vector<uint8_t>& flags, int width, int height, int x, int y) {
  int count = 0;
  for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
      count += flags[static_cast<std::size_t>(v) * width + u];
  return count - flags[static_cast<std::size_t>(y) * width + x];
}

template <typename Rule>
std::vector<uint8_t> by_neighbours(const std::vector<uint8_t>& flags, const ColourGrid& grid, Rule rule) {
  std::vector<uint8_t> result(flags.size());
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * grid.width + x;
      result[at] = rule(flags[at], flagged_around(flags, grid.width, grid.height, x, y));
    }
  return result;
}

}  // namespace

std::vector<uint8_t> moved_cells(const DepthView& keyframe, std::span<const DepthView> others,
                                 const DepthNoise& noise) {
  const ColourGrid& grid = keyframe.grid;
  const Intrinsics& k = keyframe.camera.intrinsics;
  const Pose to_world = keyframe.camera.world_to_camera.inverse();
  std::vector<uint8_t> flags(grid.depth.size());
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * grid.width + x;
      const double z = grid.depth[at];
      if (z == 0) continue;
      const Eigen::Vector2d pixel = middle_of(grid, x, y);
      const Eigen::Vector3d world =
          to_world * Eigen::Vector3d(z * (pixel.x() - k.cx) / k.fx, z * (pixel.y() - k.cy) / k.fy, z);
      flags[at] = std::any_of(others.begin(), others.end(),
                              [&](const DepthView& other) { return looks_through(other, world, noise); });
    }
  flags =
      by_neighbours(flags, grid, [](bool flag, int around) { return flag && around >= kFewestNeighbours; });
  if (std::count(flags.begin(), flags.end(), 1) < kFewestCells) return {};
  // The cells that were left out at the border of what moves, and one more.
  for (int rim = 0; rim < 2; ++rim)
    flags = by_neighbours(flags, grid, [](bool flag, int around) { return flag || around > 0; });
  return flags;
}

std::vector<uint8_t> pixels_of_cells(const std::vector<uint8_t>& cells, const ColourGrid& grid,
                                     cv::Size size) {
  std::vector<uint8_t> pixels(static_cast<std::size_t>(size.area()));
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const int x = std::min(u / grid.cell, grid.width - 1), y = std::min(v / grid.cell, grid.height - 1);
      pixels[static_cast<std::size_t>(v) * size.width + u] =
          cells[static_cast<std::size_t>(y) * grid.width + x];
    }
  return pixels;
}

}  // namespace surefield
