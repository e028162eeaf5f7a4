#include "engine/eval/loop_metrics.h"

#include <algorithm>

namespace surefield {

namespace {

/// How the camera came to each keyframe from the first: metres of path and radians of turning.
class Way {
 public:
  explicit Way(const std::vector<PlaceView>& keyframes) {
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      const Pose& now = keyframes[k].camera.world_to_camera;
      const Pose motion = (k == 0 ? now : keyframes[k - 1].camera.world_to_camera) * now.inverse();
      metres_.push_back((k == 0 ? 0 : metres_.back()) + motion.translation().norm());
      radians_.push_back((k == 0 ? 0 : radians_.back()) + Eigen::AngleAxisd(motion.linear()).angle());
    }
  }

  /// Whether `earlier` lies far enough before `later` to be revisited.
  bool is_back(int earlier, int later, const LoopCriteria& criteria) const {
    return later - earlier >= criteria.keyframes && (metres_[later] - metres_[earlier] > criteria.path ||
                                                     radians_[later] - radians_[earlier] > criteria.turned);
  }

 private:
  std::vector<double> metres_, radians_;
};

/// How far an edge is from the truth.
struct EdgeError {
  double position = 0;  ///< metres
  double rotation = 0;  ///< radians
};

EdgeError error_of(const LoopEdge& edge, const std::vector<PlaceView>& keyframes) {
  const Pose truth =
      keyframes[edge.to].camera.world_to_camera * keyframes[edge.from].camera.world_to_camera.inverse();
  const Pose off = edge.from_to * truth.inverse();
  return {(edge.from_to.translation() - truth.translation()).norm(), Eigen::AngleAxisd(off.linear()).angle()};
}

}  // namespace

KeyframeTable shared_on_return(const std::vector<PlaceView>& keyframes, const LoopCriteria& criteria) {
  const Way way(keyframes);
  KeyframeTable shared;
  for (int k = 0; k < static_cast<int>(keyframes.size()); ++k) {
    shared.emplace_back(k, 0.0);
    for (int j = 0; j < k; ++j)
      if (way.is_back(j, k, criteria))
        shared[k][j] =
            std::min(shared_view(keyframes[k], keyframes[j]), shared_view(keyframes[j], keyframes[k]));
  }
  return shared;
}

std::vector<Revisit> find_revisits(const KeyframeTable& shared, const LoopCriteria& criteria) {
  std::vector<Revisit> revisits;
  for (int k = 0; k < static_cast<int>(shared.size()); ++k) {
    if (shared[k].empty() || *std::max_element(shared[k].begin(), shared[k].end()) < criteria.shared)
      continue;
    if (!revisits.empty() && revisits.back().last == k - 1)
      revisits.back().last = k;
    else
      revisits.push_back({k, k});
  }
  return revisits;
}

LoopMetrics measure_loops(const std::vector<PlaceView>& keyframes, const std::vector<LoopEdge>& accepted,
                          const LoopCriteria& criteria) {
  const Way way(keyframes);
  LoopMetrics metrics;
  metrics.revisits = find_revisits(shared_on_return(keyframes, criteria), criteria);
  metrics.edges = static_cast<int>(accepted.size());
  for (const LoopEdge& edge : accepted) {
    const EdgeError error = error_of(edge, keyframes);
    metrics.largest = std::max(metrics.largest, error.position);
    metrics.wrong += error.position > criteria.false_position || error.rotation > criteria.false_rotation;
    if (error.position > criteria.closed_position || error.rotation > criteria.closed_rotation) continue;
    ++metrics.right;
    const auto [earlier, later] = std::minmax(edge.from, edge.to);
    if (!way.is_back(earlier, later, criteria)) continue;
    for (Revisit& revisit : metrics.revisits)
      revisit.closed = revisit.closed || (later >= revisit.first && later <= revisit.last);
  }
  metrics.closed = static_cast<int>(std::count_if(metrics.revisits.begin(), metrics.revisits.end(),
                                                  [](const Revisit& revisit) { return revisit.closed; }));
  return metrics;
}

}  // namespace surefield
