#pragma once

#include <span>

#include "tests/reference/types.h"

namespace surefield::reference {

/// Renders `gaussians` from `camera` (docs/method.md, "Forward"), every Gaussian evaluated at every pixel.
/// `sensor_depth` (metres, row-major; empty: none) is the D of the uncertainty image. Where `decisions` is
/// given, it receives the discrete decisions that were taken.
Images render(const Gaussians& gaussians, const Camera& camera, std::span<const float> sensor_depth,
              const Settings& settings = {}, Decisions* decisions = nullptr);

/// As render(), but takes each discrete decision as recorded in `decisions`, so that the result is a smooth
/// function of `gaussians` and `camera`: the function whose gradient backward() computes. Has no edge flags.
Images replay(const Gaussians& gaussians, const Camera& camera, std::span<const float> sensor_depth,
              const Decisions& decisions, const Settings& settings = {});

/// Derivatives of L with respect to every parameter of `gaussians` and the pose of `camera` (docs/method.md,
/// "Backward"), where `upstream` holds those of L with respect to the images that render() gives for the same
/// arguments. Discrete decisions count as constants.
Gradients backward(const Gaussians& gaussians, const Camera& camera, std::span<const float> sensor_depth,
                   const ImageGradients& upstream, const Settings& settings = {},
                   PoseTerms pose_terms = PoseTerms::full);

}  // namespace surefield::reference
