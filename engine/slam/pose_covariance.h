#pragma once

#include "engine/splat/pose_evidence.h"
#include "engine/types/camera.h"

namespace surefield {

/// Covariance of a small motion of a camera in its own frame: translation (metres), then rotation (radians),
/// as in PoseEvidence.
using PoseCovariance = PoseEvidence::Matrix;

/// How uncertain a pose is that was found on this evidence (docs/method.md, "Knowing when it is wrong").
/// Zeros where there is no evidence; infinite in all directions where it leaves one open.
PoseCovariance covariance_of(const PoseEvidence& evidence);

/// How far a prediction of the pose is usually off, one standard deviation in each direction.
struct PredictionError {
  double position = 0;  ///< metres
  double rotation = 0;  ///< radians
};

/// The most likely pose (world to camera) between the one that was predicted and the one that a frame was
/// aligned at: it follows the frame in directions of which the evidence knows more than the prediction does,
/// and stays at the prediction in those that the frame leaves open.
Pose fuse(const Pose& predicted, const PredictionError& error, const Pose& aligned,
          const PoseEvidence& evidence);

/// The standard deviation of the position in its most uncertain direction, metres.
double position_sigma(const PoseCovariance& covariance);
/// The standard deviation of the rotation about its most uncertain axis, radians.
double rotation_sigma(const PoseCovariance& covariance);

}  // namespace surefield
