#include "engine/slam/loop_check.h"

#include <Eigen/Cholesky>
#include <numbers>

#include "engine/slam/depth_agreement.h"
#include "engine/slam/pose_covariance.h"

namespace surefield {

namespace {

constexpr double kRadian = std::numbers::pi / 180;  // in a degree
// Of a pair, what no alignment knows better than: metres, and of the depth.
constexpr double kLeastSigma = 1e-3, kSigmaOfDepth = 5e-3;
constexpr int kFewestSame = 20;
constexpr double kInlierShare = 0.3;  // of the matches
constexpr double kSpread = 0.05;      // of the image's width
// Aligned to keyframes beside each other, a camera is at one place: metres and radians.
constexpr double kAlignedPosition = 0.02, kAlignedRotation = 1.5 * kRadian;
constexpr double kLeastShared = 0.3, kLeastAgreeing = 0.7, kMostThrough = 0.05;
// So far a camera may have drifted: metres, of the path, of the depth for each radian turned; radians, of the
// angle.
constexpr double kDriftStart = 0.1, kDriftOfPath = 0.05, kDriftOfTurn = 0.1;
constexpr double kTurnStart = 3 * kRadian, kTurnOfTurn = 0.05, kTurnOfPath = 3 * kRadian;
constexpr double kSettledPixels = 0.5;  // pixels of correction that are none

double typical_depth(const Keyframe& keyframe) {
  return std::max(keyframe.middle.z(), 0.3);
}

double angle_of(const Pose& motion) {
  return Eigen::AngleAxisd(motion.rotation()).angle();
}

}  // namespace

Matrix6 pair_information(const PoseCovariance& covariance, const Keyframe& seen) {
  const double depth = typical_depth(seen), sigma = kLeastSigma + kSigmaOfDepth * depth;
  Matrix6 floor = Matrix6::Zero();
  floor.diagonal().head<3>().setConstant(sigma * sigma);
  floor.diagonal().tail<3>().setConstant(sigma * sigma / (depth * depth));
  if (!covariance.allFinite()) return Matrix6::Zero();
  return (covariance + floor).ldlt().solve(Matrix6::Identity());
}

/// By features where the images look alike; else where both are thought to be.
std::optional<Pose> LoopCheck::first_pose(const LoopCandidate& candidate, Loop& loop) const {
  const int newest = keyframes_.newest();
  const auto match = match_rigidly(keyframes_[candidate.keyframe].features, keyframes_[newest].features,
                                   noise_of(settings_.sensor), 3);
  if (match) loop.inliers = match->inliers;
  if (match && match->inliers >= kFewestSame && match->inliers >= kInlierShare * match->matches) {
    if (match->spread < kSpread * intrinsics_.width / intrinsics_.fx) {
      loop.verdict = LoopVerdict::Clustered;
      return std::nullopt;
    }
    return match->from_to * keyframes_.world_to_camera(candidate.keyframe);
  }
  if (candidate.similarity == 0) return keyframes_.world_to_camera(newest);
  loop.verdict = LoopVerdict::FewMatches;
  return std::nullopt;
}

/// Aligns the newest keyframe to the place and to those beside it, each alone.
bool LoopCheck::align(int place, Pose& pose, Loop& loop) const {
  const Keyframe& newest = keyframes_[keyframes_.newest()];
  loop.verdict = LoopVerdict::Unaligned;
  std::optional<Pose> at_place;
  for (int near : {place, place - 1, place + 1}) {
    if (near < 0) continue;
    const Keyframe& old = keyframes_[near];
    const PairAlignment found = engine_.align(newest.tracked, {intrinsics_, at_place.value_or(pose)},
                                              {old.tracked, old.camera}, settings_.tracking);
    if (!at_place) {
      at_place = found.world_to_camera;
      loop.measured.information = pair_information(covariance_of(found.evidence), newest);
      loop.measured.pose = *at_place * old.camera.world_to_camera.inverse();
      continue;
    }
    const Pose apart = found.world_to_camera * at_place->inverse();
    if (apart.translation().norm() > kAlignedPosition || angle_of(apart) > kAlignedRotation) return false;
  }
  pose = *at_place;
  return !loop.measured.information.isZero(0);
}

bool LoopCheck::has_same_depth(int place, const Pose& pose, Loop& loop) const {
  const Keyframe &newest = keyframes_[keyframes_.newest()], &old = keyframes_[place];
  loop.depth =
      compare_depth({newest.grid, {intrinsics_, pose}}, {old.grid, old.camera}, noise_of(settings_.sensor));
  if (loop.depth.shared < kLeastShared)
    loop.verdict = LoopVerdict::LittleShared;
  else if (loop.depth.seen_through > kMostThrough)
    loop.verdict = LoopVerdict::SeenThrough;
  else if (loop.depth.agreeing < kLeastAgreeing)
    loop.verdict = LoopVerdict::OtherDepth;
  else
    return true;
  return false;
}

bool LoopCheck::is_near(int place, const Pose& pose, Loop& loop) const {
  const int k = keyframes_.newest();
  const Keyframe& newest = keyframes_[k];
  const Pose apart = newest.camera.world_to_camera * pose.inverse();
  loop.correction_position = apart.translation().norm();
  loop.correction_rotation = angle_of(apart);
  loop.correction_pixels = median_shift({newest.grid, newest.camera}, pose);
  const double path = odometer_.path(place, k), turned = odometer_.turned(place, k);
  const double far = kDriftStart + kDriftOfPath * path + kDriftOfTurn * turned * typical_depth(newest);
  const double turn = kTurnStart + kTurnOfPath * path + kTurnOfTurn * turned;
  if (loop.correction_position < far && loop.correction_rotation < turn) return true;
  loop.verdict = LoopVerdict::TooFar;
  return false;
}

Loop LoopCheck::judge(const LoopCandidate& candidate) const {
  Loop loop{.measured = {.from = candidate.keyframe, .to = keyframes_.newest()},
            .similarity = candidate.similarity};
  const auto first = first_pose(candidate, loop);
  if (!first) return loop;
  Pose pose = *first;
  if (!align(candidate.keyframe, pose, loop) || !has_same_depth(candidate.keyframe, pose, loop) ||
      !is_near(candidate.keyframe, pose, loop))
    return loop;
  loop.verdict = loop.correction_pixels < kSettledPixels ? LoopVerdict::Agreed : LoopVerdict::Waiting;
  return loop;
}

}  // namespace surefield
