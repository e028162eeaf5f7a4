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

/// By what an estimate is brought into the truth's world before it is compared: by nothing, by a rigid
/// transform, or by one with a scale, for systems that do not know it.
enum class Alignment { None, Rigid, Similarity };

/// How a trajectory is compared with the truth.
struct TrajectoryComparison {
  double max_difference = 0.02;  ///< seconds between an estimate and its truth, at most
  Alignment alignment = Alignment::Rigid;
};

/// How far a trajectory is from the truth.
struct TrajectoryMetrics {
  int pairs = 0;            ///< poses compared
  int estimates = 0;        ///< poses in the estimate
  int lost = 0;             ///< of those, the ones that are not known
  ErrorStatistics ate;      ///< absolute error of the camera's position after alignment, metres
  RelativeError rpe_frame;  ///< over consecutive pairs
  /// Over one second; no motions where no two poses lie a second apart, and where all stamps are whole
  /// numbers, which then count frames.
  RelativeError rpe_second;
  double scale = 1;  ///< that the estimate's positions were multiplied by, first of all
  Eigen::Isometry3d alignment = Eigen::Isometry3d::Identity();  ///< estimate's world to the truth's world
};

/// Pairs each estimate with the truth nearest in time, at most `max_difference` seconds away, each pose at
/// most once: the closest stamps are paired first, as the TUM benchmark's tool does. Poses that are not
/// finite, and those of lost frames, take no part. Ordered by time.
std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth,
                                double max_difference = 0.02);

/// The rigid transform, without scale, that takes the estimated positions to the true ones with the least sum
/// of squared distances (Horn, Umeyama). At least 3 pairs, else InputError.
Eigen::Isometry3d align(const std::vector<PosePair>& pairs);

/// The error of the motion between each pair and the one that is `seconds` later: of all later pairs the one
/// whose stamp is nearest to that moment, if it is at most a tenth of `seconds` off. `pairs` are in the order
/// of time, as associate() gives them.
RelativeError relative_error(const std::vector<PosePair>& pairs, double seconds);

/// The scale by which the estimated positions, aligned too, come nearest to the true ones (Umeyama). At least
/// 3 pairs; InputError also where one of the two stands still.
double fit_scale(const std::vector<PosePair>& pairs);

/// Associates, aligns and measures. Throws InputError when fewer than 3 poses can be paired, and says how far
/// apart the stamps of the two are; and where no scale can be found that is asked for.
TrajectoryMetrics evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                      const TrajectoryComparison& comparison = {});

}  // namespace surefield
