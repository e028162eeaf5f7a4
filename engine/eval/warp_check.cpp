#include "engine/eval/warp_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr double kTextureScale = 4;        // pixels; coarser structure is left out
constexpr float kTexturedFrom = 4;         // grey levels
constexpr float kMostError = 30;           // grey levels; occlusions count no more than that
constexpr float kMostContrast = 4;         // times the mean; a single strong edge does not outvote the others
constexpr float kRim = 1.1f;               // what lies behind a depth edge is that much farther
constexpr int kRimReach = 2;               // pixels over which a depth edge may be spread
constexpr std::size_t kPoints = 2000;      // per frame
constexpr std::size_t kFewestPoints = 50;  // points that must be comparable
constexpr double kFewestShare = 0.25;      // of the points

/// Bilinear value at (x, y), or NaN beyond the image.
float sample(const cv::Mat& image, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < image.cols - 1 && y < image.rows - 1)) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const auto a = static_cast<float>(x - left), b = static_cast<float>(y - top);
  const auto *upper = image.ptr<float>(top) + left, *lower = image.ptr<float>(top + 1) + left;
  return (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
}

/// At most kPoints of them, evenly chosen.
std::vector<DepthPoint> thinned(const std::vector<DepthPoint>& points) {
  if (points.size() <= kPoints) return points;
  std::vector<DepthPoint> some;
  for (std::size_t i = 0; i < kPoints; ++i) some.push_back(points[i * points.size() / kPoints]);
  return some;
}

/// CV_32F, 0 to 255.
cv::Mat grey_of(const cv::Mat& colour) {
  cv::Mat grey, values;
  cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
  grey.convertTo(values, CV_32F);
  return values;
}

/// Whether something well behind is seen within kRimReach pixels, in a row or in a column.
bool is_rim(const cv::Mat& depth, int x, int y) {
  const float limit = kRim * depth.at<float>(y, x);
  for (int d = 1; d <= kRimReach; ++d) {
    if (depth.at<float>(y, x - d) > limit || depth.at<float>(y, x + d) > limit) return true;
    if (depth.at<float>(y - d, x) > limit || depth.at<float>(y + d, x) > limit) return true;
  }
  return false;
}

/// The pixels with depth for which `test`(x, y) holds, thinned.
template <typename Test>
std::vector<DepthPoint> points_where(const cv::Mat& depth, Test test) {
  std::vector<DepthPoint> points;
  for (int y = kRimReach; y + kRimReach < depth.rows; ++y) {
    for (int x = kRimReach; x + kRimReach < depth.cols; ++x) {
      const float z = depth.at<float>(y, x);
      if (z > 0 && test(x, y)) points.push_back({static_cast<float>(x), static_cast<float>(y), z});
    }
  }
  return thinned(points);
}

/// Colour and depth camera under a correction.
class CorrectedCamera {
 public:
  CorrectedCamera(const Intrinsics& k, const Correction& c)
      : fx_(k.fx * c.focal * c.aspect),
        fy_(k.fy * c.focal / c.aspect),
        cx_(k.cx),
        cy_(k.cy),
        // A depth pixel belongs where the shift takes it; its ray is that of the place where it belongs.
        depth_x_(c.depth_focal),
        shift_x_(c.shift_x),
        shift_y_(c.shift_y),
        scale_(c.depth_scale) {}

  Eigen::Vector3d point(const DepthPoint& p) const {
    const double u = (p.x - cx_) * depth_x_ + shift_x_, v = (p.y - cy_) * depth_x_ + shift_y_;
    const double z = scale_ * p.z;
    return {u / fx_ * z, v / fy_ * z, z};
  }

  float seen(const cv::Mat& image, const Eigen::Vector3d& x) const {
    if (!(x.z() > 0)) return std::numeric_limits<float>::quiet_NaN();
    return sample(image, fx_ * x.x() / x.z() + cx_, fy_ * x.y() / x.z() + cy_);
  }

 private:
  double fx_, fy_, cx_, cy_, depth_x_, shift_x_, shift_y_, scale_;
};

bool needs_pose(const Correction& correction, const CheckFrame& frame) {
  return correction.depth_delay != 0 || frame.depth_timestamp != frame.timestamp;
}

/// From the frame of the depth image to that of the colour image, which may have been taken at another time.
std::optional<Eigen::Isometry3d> depth_to_colour(const CheckScene& scene, const CheckFrame& frame,
                                                 const Correction& correction) {
  if (!needs_pose(correction, frame)) return Eigen::Isometry3d::Identity();
  const auto colour = scene.track.at(frame.timestamp + correction.pose_delay);
  const auto depth = scene.track.at(frame.depth_timestamp + correction.pose_delay + correction.depth_delay);
  // Without poses near enough the two images are taken as one, unless their delay is the question.
  if ((!colour || !depth) && correction.depth_delay == 0) return Eigen::Isometry3d::Identity();
  if (!colour || !depth) return std::nullopt;
  return colour->inverse() * *depth;
}

/// A mean over those of `total` points that could be compared.
class ShareMean {
 public:
  void add(float value) {
    if (std::isnan(value)) return;
    sum_ += value;
    ++count_;
  }
  std::optional<double> mean(std::size_t total) const {
    const auto needed = static_cast<std::size_t>(kFewestShare * static_cast<double>(total));
    if (count_ < std::max(kFewestPoints, needed)) return std::nullopt;
    return sum_ / static_cast<double>(count_);
  }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

std::optional<double> texture_error(const CheckScene& scene, const FramePair& pair,
                                    const Correction& correction) {
  const CheckFrame &from = scene.frames[pair.from], &to = scene.frames[pair.to];
  const auto registered = depth_to_colour(scene, from, correction);
  const auto from_pose = scene.track.at(from.timestamp + correction.pose_delay);
  const auto to_pose = scene.track.at(to.timestamp + correction.pose_delay);
  if (!registered || !from_pose || !to_pose) return std::nullopt;
  const Eigen::Isometry3d motion = to_pose->inverse() * *from_pose;
  const CorrectedCamera camera(scene.intrinsics, correction);
  ShareMean mean;
  for (const DepthPoint& point : from.points) {
    const Eigen::Vector3d x = *registered * camera.point(point);
    const float difference = std::abs(camera.seen(from.texture, x) - camera.seen(to.texture, motion * x));
    mean.add(std::isnan(difference) ? difference : std::min(difference, kMostError));
  }
  return mean.mean(from.points.size());
}

std::optional<double> edge_strength(const CheckScene& scene, const CheckFrame& frame,
                                    const Correction& correction) {
  const auto registered = depth_to_colour(scene, frame, correction);
  if (!registered) return std::nullopt;
  const CorrectedCamera camera(scene.intrinsics, correction);
  ShareMean mean;
  for (const DepthPoint& point : frame.rims) {
    mean.add(camera.seen(frame.contrast, *registered * camera.point(point)));
  }
  return mean.mean(frame.rims.size());
}

}  // namespace

CheckFrame prepare_frame(const Frame& frame, double depth_timestamp) {
  CheckFrame check;
  check.index = frame.index;
  check.timestamp = frame.timestamp;
  check.depth_timestamp = depth_timestamp;
  check.depth = frame.depth;
  cv::Mat smooth;
  check.grey = grey_of(frame.colour);
  cv::GaussianBlur(check.grey, smooth, {}, kTextureScale);
  check.texture = check.grey - smooth;
  check.contrast = edge_contrast(frame.colour);
  check.points = points_where(
      check.depth, [&](int x, int y) { return std::abs(check.texture.at<float>(y, x)) > kTexturedFrom; });
  check.rims = depth_rims(check.depth);
  return check;
}

cv::Mat edge_contrast(const cv::Mat& colour) {
  cv::Mat smooth, along_x, along_y, contrast;
  cv::GaussianBlur(grey_of(colour), smooth, {}, 1);
  cv::Sobel(smooth, along_x, CV_32F, 1, 0);
  cv::Sobel(smooth, along_y, CV_32F, 0, 1);
  cv::magnitude(along_x, along_y, contrast);
  const double mean = cv::mean(contrast)[0];
  if (mean > 0) contrast = cv::min(contrast * (1 / mean), kMostContrast);
  return contrast;
}

std::vector<DepthPoint> depth_rims(const cv::Mat& depth) {
  return points_where(depth, [&](int x, int y) { return is_rim(depth, x, y); });
}

std::optional<double> mean_contrast(const cv::Mat& contrast, const std::vector<DepthPoint>& rims,
                                    const cv::Point2d& shift) {
  ShareMean mean;
  for (const DepthPoint& point : rims) mean.add(sample(contrast, point.x + shift.x, point.y + shift.y));
  return mean.mean(rims.size());
}

std::vector<std::optional<double>> texture_errors(const CheckScene& scene, const Correction& correction) {
  std::vector<std::optional<double>> errors;
  for (const FramePair& pair : scene.pairs) errors.push_back(texture_error(scene, pair, correction));
  return errors;
}

std::vector<std::optional<double>> edge_strengths(const CheckScene& scene, const Correction& correction) {
  std::vector<std::optional<double>> strengths;
  for (const CheckFrame& frame : scene.frames) strengths.push_back(edge_strength(scene, frame, correction));
  return strengths;
}

WarpError warp_error(const CheckScene& scene) {
  constexpr double kSameSurface = 0.05;  // of the depth; what differs more is taken for hidden
  WarpError error;
  double grey_sum = 0;
  std::size_t compared = 0;
  std::vector<double> depths;
  const CorrectedCamera camera(scene.intrinsics, {});
  for (const FramePair& pair : scene.pairs) {
    const CheckFrame &from = scene.frames[pair.from], &to = scene.frames[pair.to];
    const auto from_pose = scene.track.at(from.timestamp), to_pose = scene.track.at(to.timestamp);
    if (!from_pose || !to_pose) continue;
    const Eigen::Isometry3d motion = to_pose->inverse() * *from_pose;
    ++error.pairs;
    for (int y = 0; y < from.depth.rows; y += 2) {
      for (int x = 0; x < from.depth.cols; x += 2) {
        const float z = from.depth.at<float>(y, x);
        if (!(z > 0)) continue;
        const Eigen::Vector3d there =
            motion * camera.point({static_cast<float>(x), static_cast<float>(y), z});
        const double seen = camera.seen(to.depth, there);
        const double step = std::abs(seen - there.z());
        if (!(seen > 0) || !(step < kSameSurface * there.z())) continue;
        depths.push_back(step);
        grey_sum += std::abs(camera.seen(to.grey, there) - from.grey.at<float>(y, x));
        ++compared;
      }
    }
  }
  if (compared == 0) return error;
  error.grey_levels = grey_sum / static_cast<double>(compared);
  error.depth_median = median(depths);
  return error;
}

}  // namespace surefield
