// Shells of rooms: floor, ceiling and walls with openings.
#include <algorithm>

#include "engine/synth/furniture.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kSkirtingHeight = 0.08;
constexpr double kSkirtingDepth = 0.012;

/// One wall of a room: where it runs, and its inner face.
struct WallRun {
  int along;           ///< axis that it runs along, 0 or 1
  Vector3d low, high;  ///< corners of its box without openings
  double inner;        ///< coordinate of its inner face across
  double inward;       ///< 1 or -1
};

/// The part of a wall between two places along it and two heights.
void piece(SceneBuilder& b, const WallRun& run, const Opening& part, int material) {
  if (part.to - part.from < 1e-9 || part.high - part.low < 1e-9) return;
  Vector3d low = run.low, high = run.high;
  low[run.along] = part.from;
  high[run.along] = part.to;
  low.z() = part.low;
  high.z() = part.high;
  b.wall(low, high, material);
}

void skirting(SceneBuilder& b, const WallRun& run, double from, double to, double floor, int material) {
  if (to - from < 0.05) return;
  const double outer = run.inner + run.inward * kSkirtingDepth;
  Vector3d low, high;
  low[run.along] = from;
  high[run.along] = to;
  low[1 - run.along] = std::min(run.inner, outer);
  high[1 - run.along] = std::max(run.inner, outer);
  low.z() = floor;
  high.z() = floor + kSkirtingHeight;
  b.wall(low, high, material);
}

void build_wall(SceneBuilder& b, const WallRun& run, const RoomPlan& plan, std::vector<Opening> openings,
                int material) {
  std::sort(openings.begin(), openings.end(), [](const auto& x, const auto& y) { return x.from < y.from; });
  double at = run.low[run.along];
  double free_from = plan.low[run.along];
  for (const Opening& hole : openings) {
    piece(b, run, {at, hole.from, run.low.z(), run.high.z()}, material);
    piece(b, run, {hole.from, hole.to, run.low.z(), hole.low}, material);
    piece(b, run, {hole.from, hole.to, hole.high, run.high.z()}, material);
    at = hole.to;
    if (hole.low > plan.low.z() + kSkirtingHeight) continue;
    skirting(b, run, free_from, hole.from, plan.low.z(), plan.skirting);
    free_from = hole.to;
  }
  piece(b, run, {at, run.high[run.along], run.low.z(), run.high.z()}, material);
  skirting(b, run, free_from, plan.high[run.along], plan.low.z(), plan.skirting);
}

}  // namespace

void build_room(SceneBuilder& b, const RoomPlan& plan) {
  const double t = kWallThickness;
  const Vector3d low = plan.low, high = plan.high;
  b.begin("room");
  b.wall({low.x() - t, low.y() - t, low.z() - t}, {high.x() + t, high.y() + t, low.z()}, plan.floor);
  b.wall({low.x() - t, low.y() - t, high.z()}, {high.x() + t, high.y() + t, high.z() + t}, plan.ceiling);
  const WallRun runs[4] = {
      {1, {low.x() - t, low.y(), low.z()}, {low.x(), high.y(), high.z()}, low.x(), 1},
      {1, {high.x(), low.y(), low.z()}, {high.x() + t, high.y(), high.z()}, high.x(), -1},
      {0, {low.x() - t, low.y() - t, low.z()}, {high.x() + t, low.y(), high.z()}, low.y(), 1},
      {0, {low.x() - t, high.y(), low.z()}, {high.x() + t, high.y() + t, high.z()}, high.y(), -1}};
  for (int i = 0; i < 4; ++i) build_wall(b, runs[i], plan, plan.openings[i], plan.walls[i]);
}

}  // namespace surefield
