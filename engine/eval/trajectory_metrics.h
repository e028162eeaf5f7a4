#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "engine/types/trajectory.h"

namespace surefield {

/// An estimated pose and the true pose of the same moment. Camera to world, metres.
struct PosePair {
  double timestamp = 0;  ///< of the estimate, seconds
  Eigen::Isometry3d estimate = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
};

/// Root mean square, mean, median and largest of a set of errors, in the unit of the errors.
struct ErrorStatistics {
  double rmse = 0;
  double mean = 0;
  double median = 0;
  double max = 0;
};

/// Relative pose error: how far the estimated motion over some time is from the true motion over that time.
struct RelativeError {
  int motions = 0;         ///< motions compared
  double translation = 0;  ///< RMSE, metres
  double rotation = 0;     ///< RMSE of the angle, radians
};

/// How far a trajectory is from the truth.
struct TrajectoryMetrics {
  int pairs = 0;             ///< poses compared
  int estimates = 0;         ///< poses in the estimate
  ErrorStatistics ate;       ///< absolute error of the camera's position after alignment, metres
  RelativeError rpe_frame;   ///< over consecutive pairs
  RelativeError rpe_second;  ///< over one second of the time stamps; no motions where they have none
  Eigen::Isometry3d alignment = Eigen::Isometry3d::Identity();  ///< estimate's world to the truth's world
};

/// Pairs each estimate with the truth nearest in time, at most `max_difference` seconds away, each pose at
/// most once: the closest stamps are paired first, as the TUM benchmark's tool does. Poses that are not
/// finite take no part. Ordered by time.
std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth,
                                double max_difference = 0.02);

/// The rigid transform, without scale, that takes the estimated positions to the true ones with the least sum
/// of squared distances (Horn, Umeyama). At least 3 pairs, else InputError.
Eigen::Isometry3d align(const std::vector<PosePair>& pairs);

/// The error of the motion between each pair and the one that is `seconds` later: of all later pairs the one
/// whose stamp is nearest to that moment, if it is at most a tenth of `seconds` off. `pairs` are in the order
/// of time, as associate() gives them.
RelativeError relative_error(const std::vector<PosePair>& pairs, double seconds);

/// Associates, aligns and measures. Throws InputError when fewer than 3 poses can be paired.
TrajectoryMetrics evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                      double max_difference = 0.02);

}  // namespace surefield
