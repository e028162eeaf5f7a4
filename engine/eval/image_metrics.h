#pragma once

#include <opencv2/core.hpp>

namespace surefield {

/// Peak signal-to-noise ratio in dB over all pixels and channels of two float images (CV_32F, values in [0,
/// 1]) of one size and number of channels; infinity where they are equal. Throws InputError when the images
/// do not match, are empty or hold NaN.
double psnr(const cv::Mat& image, const cv::Mat& reference);

}  // namespace surefield
