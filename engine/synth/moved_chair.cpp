#include "engine/synth/moved_chair.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "engine/types/error.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr int kLookEvery = 5;      // frames
constexpr double kVisible = 0.01;  // of the image
constexpr int kShortestGap = 30;   // frames
constexpr double kTurn = 40 * std::numbers::pi / 180;
constexpr double kDistances[] = {0.5, 0.35, 0.25};  // metres
constexpr int kWays = 12;
constexpr double kAir = 0.03;    // metres to everything else
constexpr double kTouch = 2e-3;  // metres

/// The time between two visits to an object, frames.
struct Gap {
  int from = 0, to = 0;
  int length() const { return to - from; }
};

Eigen::AlignedBox3d bounds_of(const Shape& shape) {
  const Vector3d reach = shape.shape_to_world.linear().cwiseAbs() * shape.half_size;
  const Vector3d centre = shape.shape_to_world.translation();
  return {centre - reach, centre + reach};
}

Eigen::AlignedBox3d bounds_of(const Scene& scene, int object) {
  Eigen::AlignedBox3d bounds;
  for (const Shape& shape : scene.shapes)
    if (shape.object == object) bounds.extend(bounds_of(shape));
  return bounds;
}

/// Whether an object stands with all corners on something, and has air around it.
bool stands_free(const Scene& scene, int object) {
  const Eigen::AlignedBox3d own = bounds_of(scene, object);
  Eigen::AlignedBox3d around(own.min() - Vector3d(kAir, kAir, 0), own.max() + Vector3d(kAir, kAir, 0));
  around.min().z() += kTouch;
  int held = 0;
  for (const Shape& shape : scene.shapes) {
    if (shape.object == object) continue;
    const Eigen::AlignedBox3d other = bounds_of(shape);
    if (around.intersects(other)) return false;
    if (std::abs(other.max().z() - own.min().z()) > kTouch) continue;
    for (const double x : {own.min().x(), own.max().x()})
      for (const double y : {own.min().y(), own.max().y()})
        held += other.contains(Vector3d(x, y, other.max().z())) ? 1 : 0;
  }
  return held >= 4;
}

/// The scene with an object turned and moved to where there is room; nothing where there is none.
std::optional<Scene> moved(const Scene& scene, int object) {
  const Vector3d middle = bounds_of(scene, object).center();
  for (const double distance : kDistances) {
    for (int i = 0; i < kWays; ++i) {
      const double angle = 2 * std::numbers::pi * i / kWays;
      const Vector3d way = distance * Vector3d(std::cos(angle), std::sin(angle), 0);
      const Eigen::Isometry3d motion = Eigen::Translation3d(middle + way) *
                                       Eigen::AngleAxisd(kTurn, Vector3d::UnitZ()) *
                                       Eigen::Translation3d(-middle);
      Scene changed = scene;
      for (Shape& shape : changed.shapes) {
        if (shape.object != object) continue;
        shape.shape_to_world = motion * shape.shape_to_world;
        shape.texture_origin = shape.shape_to_world.translation();
      }
      if (stands_free(changed, object)) return changed;
    }
  }
  return std::nullopt;
}

bool is_chair(const std::string& object) {
  return object == "chair" || object == "swivel chair";
}

/// The longest time between two visits, of each object.
std::vector<Gap> longest_gaps(const Scene& scene, int frames, const VisibleShares& visible) {
  std::vector<Gap> longest(scene.objects.size());
  std::vector<int> last_seen(scene.objects.size(), -1);
  for (int frame = 0; frame < frames; frame += kLookEvery) {
    const std::vector<double> shares = visible(frame);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      if (shares[i] < kVisible) continue;
      const Gap gap{last_seen[i], frame};
      if (last_seen[i] >= 0 && gap.length() > longest[i].length()) longest[i] = gap;
      last_seen[i] = frame;
    }
  }
  return longest;
}

}  // namespace

MovedChair move_chair(const Scene& scene, int frames, const VisibleShares& visible) {
  const std::vector<Gap> gaps = longest_gaps(scene, frames, visible);
  std::optional<MovedChair> best;
  int longest = kShortestGap - 1;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (!is_chair(scene.objects[i]) || gaps[i].length() <= longest) continue;
    const int object = static_cast<int>(i);
    std::optional<Scene> changed = moved(scene, object);
    if (!changed) continue;
    longest = gaps[i].length();
    best = {std::move(*changed), object, gaps[i].from + longest / 2};
  }
  if (best) return std::move(*best);
  throw InputError(
      fmt::format("scene {}: no chair with room to move is seen, then not seen, and seen again within {} "
                  "frames; take more frames, or a path that comes back",
                  scene.name, frames));
}

}  // namespace surefield
