#include "engine/slam/loop_closer.h"

#include <numbers>
#include <utility>

namespace surefield {

namespace {

constexpr int kRest = 5;         // keyframes, after one that has found its place as it is thought to be
constexpr int kConsecutive = 2;  // keyframes before the newest that may say the same
// Corrections that say the same, metres and radians.
constexpr double kSamePosition = 0.03, kSameRotation = 1.5 * std::numbers::pi / 180;
constexpr double kContradicted = 16.8;  // chi2 of an edge that only one in a hundred right ones has
constexpr RobustKernel kLoopKernel{RobustKernel::Kind::Cauchy, 3};

}  // namespace

void LoopCloser::begin() {
  odometer_ = {};
  odometer_.add(keyframes_, -1);
}

std::optional<int> LoopCloser::close(int before, const PoseCovariance& covariance) {
  odometer_.add(keyframes_, before);
  add_odometry(before, covariance);
  if (keyframes_.newest() < rest_until_) return std::nullopt;
  return follow(look());
}

std::optional<int> LoopCloser::follow(const std::vector<Loop>& judged) {
  loops_.insert(loops_.end(), judged.begin(), judged.end());
  const int newest = keyframes_.newest();
  if (!judged.empty() && judged.back().verdict == LoopVerdict::Agreed) rest_until_ = newest + kRest;
  const auto both = confirmed();
  if (!both) return std::nullopt;
  const auto [first, second] = *both;
  loops_[first].verdict = loops_[second].verdict = LoopVerdict::Accepted;
  rest_until_ = newest + kRest;
  if (correct()) return loops_[second].measured.from;
  loops_[first].verdict = loops_[second].verdict = LoopVerdict::Contradicted;
  return std::nullopt;
}

/// As the poses are now that the newest keyframe is mapped. One measurement a keyframe: those to others that
/// it was aligned to as well err with it, and would make a chain that does not bend.
void LoopCloser::add_odometry(int before, const PoseCovariance& covariance) {
  if (before < 0) return;
  const int newest = keyframes_.newest();
  odometry_.push_back({before, newest,
                       keyframes_.world_to_camera(newest) * keyframes_.world_to_camera(before).inverse(),
                       pair_information(covariance, keyframes_[newest])});
}

/// Judges the candidates, the best first, until one is right.
std::vector<Loop> LoopCloser::look() const {
  std::vector<Loop> judged;
  for (const LoopCandidate& candidate : find_candidates(keyframes_, odometer_)) {
    judged.push_back(check_.judge(candidate));
    const LoopVerdict verdict = judged.back().verdict;
    if (verdict == LoopVerdict::Agreed || verdict == LoopVerdict::Waiting) break;
  }
  return judged;
}

std::optional<std::pair<std::size_t, std::size_t>> LoopCloser::confirmed() const {
  const int newest = keyframes_.newest();
  const auto pose_by = [&](const Loop& loop) {
    return loop.measured.pose * keyframes_.world_to_camera(loop.measured.from);
  };
  if (loops_.empty() || loops_.back().verdict != LoopVerdict::Waiting || loops_.back().measured.to != newest)
    return std::nullopt;
  const Pose now = pose_by(loops_.back());
  for (std::size_t i = loops_.size() - 1; i-- > 0;) {
    const Loop& other = loops_[i];
    if (other.measured.to < newest - kConsecutive) break;
    if (other.verdict != LoopVerdict::Waiting || other.measured.to == newest) continue;
    // Where the newest keyframe would be if the other had told the correction.
    const Pose expected = keyframes_.world_to_camera(newest) *
                          keyframes_.world_to_camera(other.measured.to).inverse() * pose_by(other);
    const Pose apart = now * expected.inverse();
    if (apart.translation().norm() < kSamePosition &&
        Eigen::AngleAxisd(apart.rotation()).angle() < kSameRotation)
      return std::pair(i, loops_.size() - 1);
  }
  return std::nullopt;
}

/// Solves for all poses; nothing has changed where a loop is contradicted then.
bool LoopCloser::correct() {
  PoseGraph graph;
  for (const Keyframe& keyframe : keyframes_.all())
    graph.add_vertex(keyframe.camera.world_to_camera, graph.vertices() == 0);
  for (const RelativePose& edge : odometry_) graph.add_edge(edge);
  const int loops = graph.edges();
  const auto add_loops = [&](const RobustKernel& kernel) {
    while (graph.edges() > loops) graph.remove_edge(graph.edges() - 1);
    for (const Loop& loop : loops_)
      if (loop.counts()) graph.add_edge(loop.measured, kernel);
    graph.solve();
  };
  // Before they are followed, loops are so far off that a kernel would leave them out; afterwards it lets go
  // of those that are not like the others.
  add_loops({});
  add_loops(kLoopKernel);
  for (int loop = loops; loop < graph.edges(); ++loop)
    if (graph.chi2(loop) > kContradicted) return false;
  apply(graph);
  return true;
}

void LoopCloser::apply(const PoseGraph& graph) {
  std::vector<Pose> motions;
  for (int k = 0; k < graph.vertices(); ++k) {
    motions.push_back(graph.pose(k).inverse() * keyframes_.world_to_camera(k));
    keyframes_.move(k, graph.pose(k));
  }
  engine_.move(motions);
}

}  // namespace surefield
