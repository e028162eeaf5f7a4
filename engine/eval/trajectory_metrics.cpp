#include "engine/eval/trajectory_metrics.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kFewestPairs = 3;  // below that no alignment is determined

/// The poses that are finite, in the order of time.
std::vector<StampedPose> usable_poses(const Trajectory& trajectory) {
  std::vector<StampedPose> poses;
  for (const StampedPose& pose : trajectory) {
    if (pose.is_finite()) poses.push_back(pose);
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  return poses;
}

/// A pair that time allows; sorted by difference, then by position, so that the outcome is always the same.
using Candidate = std::tuple<double, std::size_t, std::size_t>;

std::vector<Candidate> find_candidates(const Trajectory& estimates, const Trajectory& truths,
                                       double max_difference) {
  std::vector<Candidate> candidates;
  for (std::size_t e = 0; e < estimates.size(); ++e) {
    const double stamp = estimates[e].timestamp;
    const auto first =
        std::lower_bound(truths.begin(), truths.end(), stamp - max_difference,
                         [](const StampedPose& pose, double earliest) { return pose.timestamp < earliest; });
    for (auto truth = first; truth != truths.end() && truth->timestamp <= stamp + max_difference; ++truth) {
      candidates.emplace_back(std::abs(truth->timestamp - stamp), e,
                              static_cast<std::size_t>(truth - truths.begin()));
    }
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

ErrorStatistics statistics(std::vector<double> errors) {
  ErrorStatistics result;
  for (double error : errors) {
    result.mean += error;
    result.rmse += error * error;
  }
  const auto count = static_cast<double>(errors.size());
  result.mean /= count;
  result.rmse = std::sqrt(result.rmse / count);
  std::sort(errors.begin(), errors.end());
  result.median = 0.5 * (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]);
  result.max = errors.back();
  return result;
}

double rotation_angle(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle();
}

/// Adds up squared errors of motions.
class MotionErrors {
 public:
  void add(const PosePair& from, const PosePair& to) {
    const Eigen::Isometry3d estimated = from.estimate.inverse() * to.estimate;
    const Eigen::Isometry3d true_motion = from.truth.inverse() * to.truth;
    const Eigen::Isometry3d error = true_motion.inverse() * estimated;
    translation_ += error.translation().squaredNorm();
    rotation_ += std::pow(rotation_angle(error.linear()), 2);
    ++motions_;
  }

  RelativeError total() const {
    if (motions_ == 0) return {};
    return {motions_, std::sqrt(translation_ / motions_), std::sqrt(rotation_ / motions_)};
  }

 private:
  int motions_ = 0;
  double translation_ = 0;
  double rotation_ = 0;
};

RelativeError consecutive_error(const std::vector<PosePair>& pairs) {
  MotionErrors errors;
  for (std::size_t i = 1; i < pairs.size(); ++i) errors.add(pairs[i - 1], pairs[i]);
  return errors.total();
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth, double max_difference) {
  const std::vector<StampedPose> estimates = usable_poses(estimate);
  const std::vector<StampedPose> truths = usable_poses(truth);
  constexpr std::size_t kFree = static_cast<std::size_t>(-1);
  std::vector<std::size_t> truth_of(estimates.size(), kFree);
  std::vector<bool> taken(truths.size(), false);
  for (const auto& [difference, e, t] : find_candidates(estimates, truths, max_difference)) {
    if (truth_of[e] != kFree || taken[t]) continue;
    truth_of[e] = t;
    taken[t] = true;
  }
  std::vector<PosePair> pairs;
  for (std::size_t e = 0; e < estimates.size(); ++e) {
    if (truth_of[e] == kFree) continue;
    pairs.push_back(
        {estimates[e].timestamp, estimates[e].camera_to_world, truths[truth_of[e]].camera_to_world});
  }
  return pairs;
}

Eigen::Isometry3d align(const std::vector<PosePair>& pairs) {
  if (pairs.size() < kFewestPairs) {
    throw InputError(
        "only " + std::to_string(pairs.size()) +
        " poses can be paired with the ground truth, at least 3 are needed; do the time stamps match?");
  }
  Eigen::Matrix3Xd estimates(3, pairs.size());
  Eigen::Matrix3Xd truths(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    estimates.col(static_cast<Eigen::Index>(i)) = pairs[i].estimate.translation();
    truths.col(static_cast<Eigen::Index>(i)) = pairs[i].truth.translation();
  }
  Eigen::Isometry3d alignment;
  alignment.matrix() = Eigen::umeyama(estimates, truths, /*with_scaling=*/false);
  return alignment;
}

RelativeError relative_error(const std::vector<PosePair>& pairs, double seconds) {
  constexpr double kTolerance = 0.1;  // of the time; camera clocks jitter, and strides seldom divide a second
  constexpr double kRounding = 1e-6;  // seconds, of stamps in files
  MotionErrors errors;
  std::size_t later = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto miss = [&](std::size_t k) {
      return std::abs(pairs[k].timestamp - pairs[i].timestamp - seconds);
    };
    if (pairs[i].timestamp + seconds > pairs.back().timestamp + kRounding) break;
    later = std::max(later, i + 1);
    // The stamps only grow, so the nearest one never lies before that of the pose before.
    while (later + 1 < pairs.size() && miss(later + 1) <= miss(later)) ++later;
    if (miss(later) <= kTolerance * seconds) errors.add(pairs[i], pairs[later]);
  }
  return errors.total();
}

TrajectoryMetrics evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                      double max_difference) {
  const std::vector<PosePair> pairs = associate(estimate, truth, max_difference);
  TrajectoryMetrics metrics;
  metrics.pairs = static_cast<int>(pairs.size());
  metrics.estimates = static_cast<int>(estimate.size());
  metrics.alignment = align(pairs);
  std::vector<double> errors;
  for (const PosePair& pair : pairs) {
    errors.push_back((metrics.alignment * pair.estimate.translation() - pair.truth.translation()).norm());
  }
  metrics.ate = statistics(std::move(errors));
  metrics.rpe_frame = consecutive_error(pairs);
  metrics.rpe_second = relative_error(pairs, 1.0);
  return metrics;
}

}  // namespace surefield
