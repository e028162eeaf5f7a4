#pragma once

#include <limits>

#include "engine/eval/frame_matches.h"
#include "engine/types/camera.h"

namespace surefield {

/// A number that was estimated, and its standard error.
struct Estimate {
  double value = 0;
  double error = std::numeric_limits<double>::infinity();  ///< infinite: nothing is known
};

/// What matched points with depth say about the focal lengths of the camera that took them.
struct LensFit {
  int pairs = 0;      ///< of frames that took part; too few of them, and nothing else is known
  double turn = 0;    ///< the most that the camera turned between the frames of a pair, about x or y, radians
  double pixels = 0;  ///< how far points are from where they should be: median, original pixels
  Estimate focal;     ///< logarithm of the factor by which fx and fy would fit
  Estimate aspect;    ///< logarithm of the factor by which fx (and 1 / it by which fy) would fit
};

/// Fits the focal lengths together with the motion between the frames of each pair. A camera that turns moves
/// the image by what its focal length is, and changes depths by what it is not: where both are measured, no
/// poses are needed. The scale of depth has no influence. Errors are by how much the pairs differ.
LensFit fit_lens(const std::vector<MatchedFrames>& pairs, const Intrinsics& intrinsics);

}  // namespace surefield
