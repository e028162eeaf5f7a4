#include "engine/eval/image_metrics.h"

#include <cmath>
#include <limits>

#include "engine/io/error.h"

namespace surefield {

double psnr(const cv::Mat& image, const cv::Mat& reference) {
  if (image.empty() || image.size() != reference.size() || image.type() != reference.type() ||
      image.depth() != CV_32F) {
    throw InputError("PSNR needs two float images of the same size and number of channels");
  }
  const double squared_sum = cv::norm(image, reference, cv::NORM_L2SQR);
  if (!std::isfinite(squared_sum)) throw InputError("PSNR: an image holds NaN or infinite values");
  const double mean = squared_sum / (static_cast<double>(image.total()) * image.channels());
  return mean == 0 ? std::numeric_limits<double>::infinity() : -10 * std::log10(mean);
}

}  // namespace surefield
