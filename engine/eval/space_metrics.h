#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "engine/types/depth_noise.h"

namespace surefield {

/// What a map has in the space that a sensor has looked through, as counts of pixels with sensor depth.
struct SpaceCounts {
  int64_t valid = 0;     ///< pixels with sensor depth
  int64_t covered = 0;   ///< of these, where the map is opaque (O > 0.5)
  int64_t floating = 0;  ///< of those, where it is opaque in front of what the sensor measured

  SpaceCounts& operator+=(const SpaceCounts& other);
  /// Shares of the valid pixels, 0 where there are none: what is covered, and what floats.
  double coverage() const;
  double floaters() const;
};

/// Whether a surface at depth z stands in free space, where the sensor has measured `sensor`, metres: nearer
/// by more than 5 cm and three standard deviations of the sensor.
bool sees_through(double z, double sensor, const DepthNoise& noise);

/// Counts over one view. `opacity` and `depth`, the normalised one, are rendered; all are CV_32FC1 of one
/// size, metres, sensor depth invalid where not positive. Throws InputError when they do not match.
SpaceCounts count_space(const cv::Mat& opacity, const cv::Mat& depth, const cv::Mat& sensor,
                        const DepthNoise& noise);

}  // namespace surefield
