#include "engine/eval/place_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace surefield {

namespace {

constexpr int kStep = 6;            // pixels between the points that are compared
constexpr double kRelative = 0.05;  // depths are the same when they differ by less than this part
constexpr double kAbsolute = 0.02;  // and this, metres

/// Of the queries with something to find, the parts that were found.
struct Sums {
  int queries = 0;
  double found = 0;
  double recall = 0;
};

void look_up(const std::vector<double>& scores, const std::vector<double>& shared, int keyframe,
             const PlaceSettings& settings, Sums& sums) {
  std::vector<std::pair<double, int>> candidates;
  int right = 0;
  for (int k = 0; k + settings.gap <= keyframe; ++k) {
    right += shared[k] >= settings.shared;
    if (scores[k] > 0) candidates.emplace_back(scores[k], k);
  }
  if (right == 0) return;
  std::sort(candidates.rbegin(), candidates.rend());
  if (static_cast<int>(candidates.size()) > settings.count) candidates.resize(settings.count);
  int hits = 0;
  for (const auto& [score, k] : candidates) hits += shared[k] >= settings.shared;
  ++sums.queries;
  sums.found += static_cast<double>(hits) / std::min(settings.count, right);
  sums.recall += static_cast<double>(hits) / right;
}

}  // namespace

double shared_view(const PlaceView& from, const PlaceView& to) {
  const Pose between = to.camera.world_to_camera * from.camera.world_to_camera.inverse();
  const Intrinsics &a = from.camera.intrinsics, &b = to.camera.intrinsics;
  int seen = 0, known = 0;
  for (int v = kStep / 2; v < a.height; v += kStep)
    for (int u = kStep / 2; u < a.width; u += kStep) {
      const double z = from.depth.at<float>(v, u);
      if (!(z > 0)) continue;
      const Eigen::Vector3d p = between * Eigen::Vector3d(z * (u - a.cx) / a.fx, z * (v - a.cy) / a.fy, z);
      const double x = b.fx * p.x() / p.z() + b.cx, y = b.fy * p.y() / p.z() + b.cy;
      const bool inside = p.z() > 0 && x >= 0 && y >= 0 && x <= b.width - 1 && y <= b.height - 1;
      const double there =
          inside ? to.depth.at<float>(static_cast<int>(std::lround(y)), static_cast<int>(std::lround(x))) : 0;
      if (inside && !(there > 0)) continue;
      ++known;
      seen += inside && std::abs(there - p.z()) < kAbsolute + kRelative * p.z();
    }
  return known == 0 ? 0 : static_cast<double>(seen) / known;
}

PlaceMetrics measure_places(const KeyframeTable& scores, const KeyframeTable& shared,
                            const PlaceSettings& settings) {
  Sums sums;
  for (std::size_t k = 0; k < scores.size(); ++k)
    look_up(scores[k], shared[k], static_cast<int>(k), settings, sums);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (sums.queries == 0) return {0, kNone, kNone};
  return {sums.queries, sums.found / sums.queries, sums.recall / sums.queries};
}

}  // namespace surefield
