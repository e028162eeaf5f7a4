#include "engine/sources/depth_registration.h"

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

constexpr float kSameSurface =
    0.05f;  // of the depth: a larger step is an edge, across which nothing is filled

/// Pixels whose centres lie in [begin, end) pixels, of `size`: first and one past the last.
struct PixelSpan {
  int first = 0;
  int last = 0;
};

PixelSpan span(double begin, double end, int size) {
  const double limit = size;
  return {static_cast<int>(std::clamp(std::ceil(begin), 0.0, limit)),
          static_cast<int>(std::clamp(std::ceil(end), 0.0, limit))};
}

/// Depth pixels seen from the colour camera.
class Splatter {
 public:
  Splatter(const DepthRegistration& cameras, cv::Mat& out) : cameras_(cameras), out_(out) {}

  /// Puts depth pixel (x, y) of depth `z`, a square at that depth, into the image behind nothing nearer.
  void add(int x, int y, float z) {
    const Intrinsics& k = cameras_.colour;
    const Eigen::Vector3d low = seen(x - 0.5, y - 0.5, z);
    const Eigen::Vector3d high = seen(x + 0.5, y + 0.5, z);
    const auto depth = static_cast<float>(0.5 * (low.z() + high.z()));
    if (!(low.z() > 0 && high.z() > 0)) return;
    const double u0 = k.fx * low.x() / low.z() + k.cx, u1 = k.fx * high.x() / high.z() + k.cx;
    const double v0 = k.fy * low.y() / low.z() + k.cy, v1 = k.fy * high.y() / high.z() + k.cy;
    const PixelSpan columns = span(std::min(u0, u1), std::max(u0, u1), k.width);
    const PixelSpan rows = span(std::min(v0, v1), std::max(v0, v1), k.height);
    for (int row = rows.first; row < rows.last; ++row) {
      auto* line = out_.ptr<float>(row);
      for (int column = columns.first; column < columns.last; ++column) {
        if (line[column] == 0 || depth < line[column]) line[column] = depth;
      }
    }
  }

 private:
  /// The point at depth `z` on the ray through (x, y) of the depth image, in the colour camera's frame.
  Eigen::Vector3d seen(double x, double y, double z) const {
    const Intrinsics& k = cameras_.depth;
    return cameras_.depth_to_colour * Eigen::Vector3d((x - k.cx) / k.fx * z, (y - k.cy) / k.fy * z, z);
  }

  const DepthRegistration& cameras_;
  cv::Mat& out_;
};

/// A depth beside a hole, and how many pixels from it.
struct Rim {
  float depth = 0;  ///< 0: none near enough
  int distance = 0;
};

/// The first depth from (x, y) in one direction, up to `reach` pixels off.
Rim find_rim(const cv::Mat& depth, cv::Point from, cv::Point step, int reach) {
  for (int distance = 1; distance <= reach; ++distance) {
    const cv::Point at = from + distance * step;
    if (at.x < 0 || at.y < 0 || at.x >= depth.cols || at.y >= depth.rows) break;
    const float z = depth.at<float>(at);
    if (z > 0) return {z, distance};
  }
  return {};
}

/// The depth between two of one surface; 0 where one is missing, an edge lies between them, or the gap is
/// wider than `widest`.
float between(const Rim& a, const Rim& b, int widest) {
  const bool same = a.depth > 0 && b.depth > 0 && a.distance + b.distance <= widest + 1 &&
                    std::abs(a.depth - b.depth) < kSameSurface * std::min(a.depth, b.depth);
  if (!same) return 0;
  const auto before = static_cast<float>(a.distance), after = static_cast<float>(b.distance);
  return (a.depth * after + b.depth * before) / (before + after);
}

/// Surfaces seen at a slant are pulled apart where the colour camera looks at them more squarely, and by more
/// pixels where it has more of them. Gaps of up to `widest` pixels are closed.
void close_gaps(cv::Mat& depth, int widest) {
  const cv::Mat before = depth.clone();
  for (int y = 1; y + 1 < depth.rows; ++y) {
    auto* out = depth.ptr<float>(y);
    const auto* here = before.ptr<float>(y);
    for (int x = 1; x + 1 < depth.cols; ++x) {
      if (here[x] > 0) continue;
      const auto rim = [&](int dx, int dy) { return find_rim(before, {x, y}, {dx, dy}, widest); };
      const float across = between(rim(-1, 0), rim(1, 0), widest);
      out[x] = across > 0 ? across : between(rim(0, -1), rim(0, 1), widest);
    }
  }
}

/// How many pixels of the colour image one of the depth image becomes, at the least 1.
int magnification(const DepthRegistration& cameras) {
  const double x = cameras.colour.fx / cameras.depth.fx, y = cameras.colour.fy / cameras.depth.fy;
  return static_cast<int>(std::clamp(std::ceil(std::max(x, y) - 1e-6), 1.0, 8.0));
}

}  // namespace

cv::Mat register_depth(const cv::Mat& depth, const DepthRegistration& cameras) {
  cv::Mat registered(cameras.colour.height, cameras.colour.width, CV_32FC1, cv::Scalar(0));
  Splatter splatter(cameras, registered);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* line = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (line[x] > 0 && std::isfinite(line[x])) splatter.add(x, y, line[x]);
    }
  }
  close_gaps(registered, magnification(cameras));
  return registered;
}

}  // namespace surefield
