#include "engine/eval/space_metrics.h"

#include <algorithm>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr float kOpaque = 0.5f;
constexpr double kNearer = 0.05;   // metres
constexpr double kDeviations = 3;  // of the sensor

double share(int64_t part, int64_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0;
}

}  // namespace

SpaceCounts& SpaceCounts::operator+=(const SpaceCounts& other) {
  valid += other.valid;
  covered += other.covered;
  floating += other.floating;
  return *this;
}

double SpaceCounts::coverage() const {
  return share(covered, valid);
}

double SpaceCounts::floaters() const {
  return share(floating, valid);
}

bool sees_through(double z, double sensor, const DepthNoise& noise) {
  return sensor - z > std::max(kNearer, kDeviations * noise.sigma(sensor));
}

SpaceCounts count_space(const cv::Mat& opacity, const cv::Mat& depth, const cv::Mat& sensor,
                        const DepthNoise& noise) {
  if (opacity.size() != sensor.size() || depth.size() != sensor.size() || opacity.type() != CV_32FC1 ||
      depth.type() != CV_32FC1 || sensor.type() != CV_32FC1)
    throw InputError("floaters: rendered and measured images do not match");
  SpaceCounts counts;
  for (int v = 0; v < sensor.rows; ++v) {
    for (int u = 0; u < sensor.cols; ++u) {
      const float z = sensor.at<float>(v, u);
      if (!(z > 0)) continue;
      ++counts.valid;
      if (!(opacity.at<float>(v, u) > kOpaque)) continue;
      ++counts.covered;
      if (sees_through(depth.at<float>(v, u), z, noise)) ++counts.floating;
    }
  }
  return counts;
}

}  // namespace surefield
