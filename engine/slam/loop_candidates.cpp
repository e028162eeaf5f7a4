#include "engine/slam/loop_candidates.h"

#include <algorithm>
#include <cstdlib>
#include <numbers>

namespace surefield {

namespace {

// A place has been left after so many keyframes and so much path, or turning.
constexpr int kLeastKeyframes = 10;
constexpr double kLeastPath = 1;                                   // metres
constexpr double kLeastTurn = 60 * std::numbers::pi / 180;         // radians
constexpr int kByLook = 3, kByPose = 1;                            // candidates
constexpr int kApart = 5;                                          // keyframes between candidates
// Of what keyframes that see the same have, the similarity that one from elsewhere must have.
constexpr double kLeastSimilarity = 0.7;
constexpr double kLeastOverlap = 0.4;  // both ways
constexpr double kNear = 3;            // metres between cameras that see the same

/// What the newest keyframe and those that are known to see the same have in similarity, the least of them.
double similarity_to_window(const KeyframeGraph& keyframes, const std::vector<double>& similarities) {
  double least = 1;
  for (int k : keyframes.window())
    if (k < static_cast<int>(similarities.size()) && keyframes.newest() - k < kLeastKeyframes)
      least = std::min(least, similarities[k]);
  return least == 1 ? 0 : least;
}

}  // namespace

void Odometer::add(const KeyframeGraph& keyframes, int before) {
  const int newest = keyframes.newest();
  double way = 0, turn = 0;
  if (before >= 0) {
    const Pose motion = keyframes.world_to_camera(newest) * keyframes.world_to_camera(before).inverse();
    way = motion.inverse().translation().norm();
    turn = Eigen::AngleAxisd(motion.rotation()).angle();
  }
  path_.push_back(newest > 0 ? path_.back() + way : 0);
  turned_.push_back(newest > 0 ? turned_.back() + turn : 0);
}

bool Odometer::has_left(int from, int to) const {
  return to - from >= kLeastKeyframes && (path(from, to) > kLeastPath || turned(from, to) > kLeastTurn);
}

std::vector<LoopCandidate> find_candidates(const KeyframeGraph& keyframes, const Odometer& odometer) {
  const int newest = keyframes.newest();
  std::vector<double> similarities = keyframes.places().similarities(newest);
  const double least = kLeastSimilarity * similarity_to_window(keyframes, similarities);
  std::vector<double> overlaps(similarities.size(), 0);
  const auto place = [&](int k) { return keyframes.world_to_camera(k).inverse().translation().eval(); };
  for (int k = 0; k < newest; ++k) {
    if (!odometer.has_left(k, newest)) {
      similarities[k] = 0;
      continue;
    }
    if ((place(k) - place(newest)).norm() < kNear)
      overlaps[k] =
          std::min(overlap(keyframes[newest], keyframes[k]), overlap(keyframes[k], keyframes[newest]));
  }
  std::vector<LoopCandidate> candidates;
  for (int k : best_apart(similarities, kByLook, kApart, least)) candidates.push_back({k, similarities[k]});
  for (int k : best_apart(overlaps, kByPose, kApart, kLeastOverlap)) {
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const LoopCandidate& candidate) {
      return std::abs(candidate.keyframe - k) <= kApart;
    });
    if (!known) candidates.push_back({k, 0});
  }
  return candidates;
}

}  // namespace surefield
