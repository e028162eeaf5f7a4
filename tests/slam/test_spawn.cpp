#include <doctest/doctest.h>

#include <cmath>

#include "engine/slam/spawn.h"

using namespace surefield;

namespace {

const Intrinsics kIntrinsics{.width = 8, .height = 6, .fx = 10, .fy = 10, .cx = 3.5, .cy = 2.5};

Frame wall(float depth) {
  Frame frame;
  frame.colour = cv::Mat(6, 8, CV_8UC3, cv::Scalar(255, 128, 0));
  frame.depth = cv::Mat(6, 8, CV_32FC1, cv::Scalar(depth));
  return frame;
}

/// What an opaque map at `depth` renders to.
RenderImages rendered(float depth) {
  RenderImages images{.width = 8, .height = 6};
  images.opacity.assign(48, 1.0f);
  images.depth_normalised.assign(48, depth);
  return images;
}

}  // namespace

TEST_CASE("the first frame spawns one Gaussian per valid pixel, where the pixel looks and in its colour") {
  Frame frame = wall(2);
  frame.depth.at<float>(0, 0) = 0;
  frame.depth.at<float>(0, 1) = NAN;
  frame.depth.at<float>(0, 2) = 99;
  Camera camera{kIntrinsics};
  camera.world_to_camera.translation() = Eigen::Vector3d(0, 0, 1);
  const SpawnSettings settings;
  const GaussianCloud cloud = spawn_gaussians(frame, camera, nullptr, settings, 5);
  REQUIRE(cloud.size() == 45);
  CHECK(cloud.means[0].isApprox(Eigen::Vector3f(2 * (3 - 3.5f) / 10, 2 * (0 - 2.5f) / 10, 1)));
  CHECK(std::exp(cloud.log_scales[0].x()) == doctest::Approx(0.2));
  CHECK(cloud.opacity_logits[0] == doctest::Approx(0));
  CHECK(0.5 + 0.28209479177387814 * cloud.sh[0] == doctest::Approx(1));
  CHECK(0.5 + 0.28209479177387814 * cloud.sh[2] == doctest::Approx(0));
  CHECK(cloud.sh.size() == 135);
}

TEST_CASE("later frames spawn where the map is thin or lies far behind") {
  const Camera camera{kIntrinsics};
  const SpawnSettings settings;
  RenderImages images = rendered(2.001f);
  CHECK(spawn_gaussians(wall(2), camera, &images, settings, 5).size() == 0);
  images.opacity[7] = 0.4f;
  CHECK(spawn_gaussians(wall(2), camera, &images, settings, 5).size() == 1);
  // The median error is 1 mm: what lies more than 5 cm in front of the map is a new surface, what lies behind
  // is not.
  Frame frame = wall(2);
  frame.depth.at<float>(3, 3) = 1.9f;
  frame.depth.at<float>(3, 4) = 1.99f;
  frame.depth.at<float>(3, 5) = 3.0f;
  CHECK(spawn_gaussians(frame, camera, &images, settings, 5).size() == 2);
  SpawnSettings never = settings;
  never.front_factor = 0;
  CHECK(spawn_gaussians(frame, camera, &images, never, 5).size() == 1);
}
