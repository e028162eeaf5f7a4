#include "engine/eval/image_metrics.h"

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr int kWindowSize = 11;
constexpr double kWindowSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

void require_comparable(const char* metric, const cv::Mat& image, const cv::Mat& reference) {
  if (image.empty() || image.size() != reference.size() || image.type() != reference.type() ||
      image.depth() != CV_32F) {
    throw InputError(std::string(metric) + " needs two float images of the same size and number of channels");
  }
}

cv::Mat blurred(const cv::Mat& image) {
  const cv::Mat window = cv::getGaussianKernel(kWindowSize, kWindowSigma, CV_64F);
  cv::Mat result;
  cv::sepFilter2D(image, result, CV_64F, window, window, cv::Point(-1, -1), 0, cv::BORDER_CONSTANT);
  return result;
}

/// The sum of SSIM over all pixels and channels.
double ssim_sum(const cv::Mat& x, const cv::Mat& y) {
  const cv::Mat mean_x = blurred(x), mean_y = blurred(y);
  const cv::Mat mean_xx = blurred(x.mul(x)), mean_yy = blurred(y.mul(y)), mean_xy = blurred(x.mul(y));
  const std::size_t count = x.total() * static_cast<std::size_t>(x.channels());
  const auto at = [](const cv::Mat& image, std::size_t i) { return image.ptr<double>()[i]; };
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double mx = at(mean_x, i), my = at(mean_y, i);
    const double variances = at(mean_xx, i) - mx * mx + at(mean_yy, i) - my * my;
    const double covariance = at(mean_xy, i) - mx * my;
    sum += (2 * mx * my + kC1) * (2 * covariance + kC2) / ((mx * mx + my * my + kC1) * (variances + kC2));
  }
  return sum;
}

double psnr_of(double squared_sum, std::size_t values) {
  if (!std::isfinite(squared_sum)) throw InputError("PSNR: an image holds NaN or infinite values");
  const double mean = squared_sum / static_cast<double>(values);
  return mean == 0 ? std::numeric_limits<double>::infinity() : -10 * std::log10(mean);
}

}  // namespace

double psnr(const cv::Mat& image, const cv::Mat& reference) {
  require_comparable("PSNR", image, reference);
  return psnr_of(cv::norm(image, reference, cv::NORM_L2SQR), image.total() * image.channels());
}

std::optional<double> psnr(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& mask) {
  require_comparable("PSNR", image, reference);
  if (mask.size() != image.size() || mask.type() != CV_8UC1) throw InputError("PSNR: the mask does not fit");
  const int pixels = cv::countNonZero(mask);
  if (pixels == 0) return std::nullopt;
  return psnr_of(cv::norm(image, reference, cv::NORM_L2SQR, mask),
                 static_cast<std::size_t>(pixels) * image.channels());
}

double ssim(const cv::Mat& image, const cv::Mat& reference) {
  require_comparable("SSIM", image, reference);
  cv::Mat x, y;
  image.convertTo(x, CV_64F);
  reference.convertTo(y, CV_64F);
  const double sum = ssim_sum(x, y);
  if (!std::isfinite(sum)) throw InputError("SSIM: an image holds NaN or infinite values");
  return sum / (static_cast<double>(image.total()) * image.channels());
}

std::optional<double> depth_l1(const cv::Mat& rendered, const cv::Mat& sensor) {
  require_comparable("depth L1", rendered, sensor);
  double sum = 0;
  int64_t count = 0;
  for (int v = 0; v < sensor.rows; ++v) {
    for (int u = 0; u < sensor.cols; ++u) {
      const double z = sensor.at<float>(v, u);
      if (!(z > 0)) continue;
      sum += std::abs(rendered.at<float>(v, u) - z);
      ++count;
    }
  }
  if (!std::isfinite(sum)) throw InputError("depth L1: a rendered depth is NaN or infinite");
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

}  // namespace surefield
