// Feeds frames of one's own to SLAM and reads poses and map: what a robot's program does with its camera.
#include <surefield/slam/slam.h>
#include <surefield/types/error.h>
#include <surefield/types/frame.h>
#include <surefield/types/gaussian_cloud.h>

#include <cmath>
#include <cstdio>

/// The frame of a camera that slides along a painted wall, 1 cm a frame: stands in for a camera's driver.
static surefield::Frame take_frame(int index, const surefield::Intrinsics& camera) {
  surefield::Frame frame{index, index / 30.0, cv::Mat(camera.height, camera.width, CV_8UC3),
                         cv::Mat(camera.height, camera.width, CV_32FC1)};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      // The wall is z = 1.6 m + x / 4, and the pixel sees it where its ray, x = slope z + 1 cm a frame, does.
      const double slope = (u - camera.cx) / camera.fx, slid = 0.01 * index;
      const double z = (1.6 + slid / 4) / (1 - slope / 4);
      const double x = slope * z + slid, y = (v - camera.cy) / camera.fy * z;
      const auto paint = [&](double a, double b) {
        return cv::saturate_cast<uchar>(128 + 90 * std::sin(a * x) * std::cos(b * y));
      };
      frame.colour.at<cv::Vec3b>(v, u) = {paint(9, 13), paint(17, 7), paint(5, 21)};
      frame.depth.at<float>(v, u) = static_cast<float>(z);
    }
  }
  return frame;
}

int main() try {
  const surefield::Intrinsics camera{160, 120, 140, 140, 79.5, 59.5};  // pixels
  surefield::Slam slam(surefield::SlamSettings{}, camera);
  for (int i = 0; i < 12; ++i) {
    const surefield::FrameReport report = slam.feed(take_frame(i, camera));
    const Eigen::Vector3d place = report.world_to_camera.inverse().translation();
    std::printf("frame %2d at %7.4f %7.4f %7.4f m%s\n", report.index, place.x(), place.y(), place.z(),
                report.lost() ? ", lost" : "");
  }
  slam.finish();
  std::printf("%zu Gaussians after %zu keyframes\n", slam.map().size(), slam.keyframes().size());
} catch (const surefield::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
