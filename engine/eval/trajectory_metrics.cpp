#include "engine/eval/trajectory_metrics.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kFewestPairs = 3;  // below that no alignment is determined
constexpr double kStandsStill = 1e-9;    // of how far away positions are: their rounding

/// The poses that are known, in the order of time.
std::vector<StampedPose> usable_poses(const Trajectory& trajectory) {
  std::vector<StampedPose> poses;
  for (const StampedPose& pose : trajectory) {
    if (pose.is_finite() && !pose.lost) poses.push_back(pose);
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

/// Where the cameras of pairs are, a column each.
struct Positions {
  explicit Positions(const std::vector<PosePair>& pairs)
      : estimates(3, pairs.size()), truths(3, pairs.size()) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      estimates.col(static_cast<Eigen::Index>(i)) = pairs[i].estimate.translation();
      truths.col(static_cast<Eigen::Index>(i)) = pairs[i].truth.translation();
    }
  }

  Eigen::Matrix3Xd estimates;
  Eigen::Matrix3Xd truths;
};

/// Whether the stamps are only the numbers of frames: no camera's clock gives whole seconds all the time.
bool count_frames(const std::vector<PosePair>& pairs) {
  return std::all_of(pairs.begin(), pairs.end(),
                     [](const PosePair& pair) { return pair.timestamp == std::floor(pair.timestamp); });
}

/// The smallest time between poses of two trajectories, each in the order of time.
double smallest_difference(const Trajectory& a, const Trajectory& b) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    smallest = std::min(smallest, std::abs(a[i].timestamp - b[k].timestamp));
    a[i].timestamp < b[k].timestamp ? ++i : ++k;
  }
  return smallest;
}

/// Says why so few poses could be paired.
[[noreturn]] void refuse_few(std::size_t pairs, const Trajectory& estimate, const Trajectory& truth,
                             double max_difference) {
  const std::vector<StampedPose> estimates = usable_poses(estimate), truths = usable_poses(truth);
  if (estimates.empty())
    throw InputError("the estimate has no pose that is known: there is nothing to compare");
  if (truths.empty())
    throw InputError("the truth has no pose that is known: there is nothing to compare with");
  const double from = estimates.front().timestamp, to = estimates.back().timestamp;
  const double true_from = truths.front().timestamp, true_to = truths.back().timestamp;
  const bool apart = from > true_to + max_difference || to < true_from - max_difference;
  std::string problem;
  if (pairs > 0) {
    problem =
        fmt::format("only {} poses can be paired with the ground truth within {} s, at least {} are needed",
                    pairs, max_difference, kFewestPairs);
  } else {
    problem = fmt::format(
        "no pose of the truth is near one of the estimate (within {} s): {}", max_difference,
        apart ? fmt::format("clocks differ by {:.3f} s", std::abs(from - true_from))
              : fmt::format("the nearest stamps are {:.3f} s apart", smallest_difference(estimates, truths)));
  }
  throw InputError(
      fmt::format("{}; the estimate has stamps from {:.3f} to {:.3f}, the truth from {:.3f} to {:.3f}",
                  problem, from, to, true_from, true_to));
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
  const Positions positions(pairs);
  Eigen::Isometry3d alignment;
  alignment.matrix() = Eigen::umeyama(positions.estimates, positions.truths, /*with_scaling=*/false);
  return alignment;
}

double fit_scale(const std::vector<PosePair>& pairs) {
  if (pairs.size() < kFewestPairs) throw InputError("at least 3 pairs of poses are needed to find a scale");
  const Positions positions(pairs);
  for (const auto* moving : {&positions.estimates, &positions.truths}) {
    const double spread = (moving->colwise() - moving->rowwise().mean()).norm();
    if (!(spread > kStandsStill * (1 + moving->norm()))) {
      throw InputError(
          fmt::format("the {} stands still: there is no scale to be found; compare it with "
                      "--align se3",
                      moving == &positions.estimates ? "estimated camera" : "true camera"));
    }
  }
  const Eigen::Matrix4d similar =
      Eigen::umeyama(positions.estimates, positions.truths, /*with_scaling=*/true);
  const double scale = std::cbrt(similar.topLeftCorner<3, 3>().determinant());
  if (!(scale > 0))
    throw InputError("no scale brings the estimate near to the truth; compare it with --align se3");
  return scale;
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
                                      const TrajectoryComparison& comparison) {
  std::vector<PosePair> pairs = associate(estimate, truth, comparison.max_difference);
  if (pairs.size() < kFewestPairs) refuse_few(pairs.size(), estimate, truth, comparison.max_difference);
  TrajectoryMetrics metrics;
  metrics.pairs = static_cast<int>(pairs.size());
  metrics.estimates = static_cast<int>(estimate.size());
  metrics.lost = metrics.estimates - static_cast<int>(usable_poses(estimate).size());
  if (comparison.alignment == Alignment::Similarity) {
    metrics.scale = fit_scale(pairs);
    for (PosePair& pair : pairs) pair.estimate.translation() *= metrics.scale;
  }
  if (comparison.alignment != Alignment::None) metrics.alignment = align(pairs);
  std::vector<double> errors;
  for (const PosePair& pair : pairs) {
    errors.push_back((metrics.alignment * pair.estimate.translation() - pair.truth.translation()).norm());
  }
  metrics.ate = statistics(std::move(errors));
  metrics.rpe_frame = consecutive_error(pairs);
  if (!count_frames(pairs)) metrics.rpe_second = relative_error(pairs, 1.0);
  return metrics;
}

}  // namespace surefield
