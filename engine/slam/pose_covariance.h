#pragma once

#include "engine/splat/pose_evidence.h"

namespace surefield {

/// Covariance of a small motion of a camera in its own frame: translation (metres), then rotation (radians),
/// as in PoseEvidence.
using PoseCovariance = PoseEvidence::Matrix;

/// How uncertain a pose is that was found on this evidence (docs/method.md, "Knowing when it is wrong").
/// Zeros where there is no evidence; infinite in all directions where it leaves one open.
PoseCovariance covariance_of(const PoseEvidence& evidence);

/// The standard deviation of the position in its most uncertain direction, metres.
double position_sigma(const PoseCovariance& covariance);
/// The standard deviation of the rotation about its most uncertain axis, radians.
double rotation_sigma(const PoseCovariance& covariance);

}  // namespace surefield
