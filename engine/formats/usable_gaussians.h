#pragma once

#include <cstddef>

#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// How many Gaussians of a file were left out.
struct LeftOutGaussians {
  std::size_t broken = 0;     ///< they have a NaN, no rotation, or no finite place, size or colour
  std::size_t invisible = 0;  ///< their opacity is 0: its logit is -infinity
};

/// Gives infinities their meaning, as other programs write them: a logit of +infinity is opaque, one of
/// -infinity is a Gaussian that is not there, ln(scale) = -infinity is flat, an uncertainty of +infinity is
/// the largest there is. Takes out what is not there and what cannot be drawn.
LeftOutGaussians keep_usable(GaussianCloud& cloud);

}  // namespace surefield
