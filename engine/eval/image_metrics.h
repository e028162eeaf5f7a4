#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace surefield {

/// Peak signal-to-noise ratio in dB over all pixels and channels of two float images (CV_32F, values in [0,
/// 1]) of one size and number of channels; infinity where they are equal. Throws InputError when the images
/// do not match, are empty or hold NaN.
double psnr(const cv::Mat& image, const cv::Mat& reference);

/// The same over the pixels where `mask` (CV_8U) is not 0; nullopt where it is 0 everywhere.
std::optional<double> psnr(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& mask);

/// Structural similarity of two float images (as for psnr()), the mean over all pixels and channels: 11 x 11
/// Gaussian window of sigma 1.5, zero outside of the image, C1 = 0.01^2, C2 = 0.03^2, which is the SSIM of
/// the mapping loss. 1 where they are equal. Throws InputError as psnr() does.
double ssim(const cv::Mat& image, const cv::Mat& reference);

/// Mean |rendered - sensor| in metres over the pixels with valid sensor depth (positive). A pixel that the
/// map leaves empty (rendered depth 0) counts with its whole depth, so that holes do not pay. Both are
/// CV_32FC1 of one size, metres; nullopt where no pixel is valid. Throws InputError when the images do not
/// match or a rendered depth that is compared is not finite.
std::optional<double> depth_l1(const cv::Mat& rendered, const cv::Mat& sensor);

}  // namespace surefield
