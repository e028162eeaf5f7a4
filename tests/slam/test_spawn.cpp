#include <doctest/doctest.h>

#include <cmath>

#include "engine/slam/birth_cells.h"
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
  frame.depth.at<float>(0, 2) = -1;
  Camera camera{kIntrinsics};
  camera.world_to_camera.translation() = Eigen::Vector3d(0, 0, 1);
  const SpawnSettings settings{.cell = 1};
  const GaussianCloud cloud = spawn_gaussians(frame, camera, nullptr, settings);
  REQUIRE(cloud.size() == 45);
  CHECK(cloud.means[0].isApprox(Eigen::Vector3f(2 * (3 - 3.5f) / 10, 2 * (0 - 2.5f) / 10, 1)));
  CHECK(std::exp(cloud.log_scales[0].x()) == doctest::Approx(0.2));
  CHECK(cloud.opacity_logits[0] == doctest::Approx(0));
  CHECK(0.5 + 0.28209479177387814 * cloud.sh[0] == doctest::Approx(1));
  CHECK(0.5 + 0.28209479177387814 * cloud.sh[2] == doctest::Approx(0));
  CHECK(cloud.sh.size() == 135);
  const GaussianCloud brighter = spawn_gaussians(frame, camera, nullptr, settings, {0.5f, 1.5f, 1});
  CHECK(0.5 + 0.28209479177387814 * brighter.sh[0] == doctest::Approx(0.5));
  CHECK(0.5 + 0.28209479177387814 * brighter.sh[1] == doctest::Approx(1.5 * 128 / 255));
}

TEST_CASE("later frames spawn where the map is thin or lies far behind") {
  const Camera camera{kIntrinsics};
  const SpawnSettings settings{.cell = 1};
  RenderImages images = rendered(2.001f);
  CHECK(spawn_gaussians(wall(2), camera, &images, settings).size() == 0);
  images.opacity[7] = 0.4f;
  CHECK(spawn_gaussians(wall(2), camera, &images, settings).size() == 1);
  // The median error is 1 mm: what lies more than 5 cm in front of the map is a new surface, what lies behind
  // is not.
  Frame frame = wall(2);
  frame.depth.at<float>(3, 3) = 1.9f;
  frame.depth.at<float>(3, 4) = 1.99f;
  frame.depth.at<float>(3, 5) = 3.0f;
  CHECK(spawn_gaussians(frame, camera, &images, settings).size() == 2);
  SpawnSettings never = settings;
  never.front_factor = 0;
  CHECK(spawn_gaussians(frame, camera, &images, never).size() == 1);
}

TEST_CASE(
    "newborns are discs on the surface, which cover the pixel in every direction; spheres where it is "
    "unknown") {
  // A plane seen at a slant, in a camera that is turned itself.
  const Intrinsics k{.width = 16, .height = 12, .fx = 80, .fy = 80, .cx = 7.5, .cy = 5.5};
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, -0.2, -1).normalized();
  Frame frame;
  frame.colour = cv::Mat(12, 16, CV_8UC3, cv::Scalar(255, 128, 0));
  frame.depth = cv::Mat(12, 16, CV_32FC1);
  for (int v = 0; v < 12; ++v)
    for (int u = 0; u < 16; ++u)
      frame.depth.at<float>(v, u) =
          static_cast<float>(-2 / normal.dot(Eigen::Vector3d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1)));
  Camera camera{k};
  camera.world_to_camera.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  SpawnSettings settings{.cell = 1};
  settings.thickness = 0.1;
  const GaussianCloud cloud = spawn_gaussians(frame, camera, nullptr, settings);
  REQUIRE(cloud.size() == 192);
  const int i = 7 * 16 + 11;
  const Eigen::Vector4f& q = cloud.rotations[i];
  const Eigen::Matrix3d axes =
      camera.world_to_camera.linear() * Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  const Eigen::Vector3d scales = cloud.log_scales[i].cast<double>().array().exp();
  const double z = frame.depth.at<float>(7, 11), radius = z / 80;
  CHECK(std::abs(axes.col(2).dot(normal)) == doctest::Approx(1).epsilon(1e-3));
  CHECK(scales[0] == doctest::Approx(radius));
  CHECK(scales[2] == doctest::Approx(0.1 * radius));
  // Stretched where the surface recedes, so that along the ray's projection it is as wide as across.
  const Eigen::Vector3d ray = Eigen::Vector3d(3.5 / 80, 1.5 / 80, 1).normalized();
  CHECK(scales[1] * std::abs(normal.dot(ray)) == doctest::Approx(radius).epsilon(1e-3));
  CHECK(std::abs(axes.col(0).dot(ray)) < 1e-3);

  settings.thickness = 1;
  CHECK(spawn_gaussians(frame, camera, nullptr, settings).log_scales[i] ==
        Eigen::Vector3f::Constant(cloud.log_scales[i].x()));
  // Alone among pixels without depth, nothing is known of the surface.
  Frame dot{.colour = frame.colour, .depth = cv::Mat(12, 16, CV_32FC1, cv::Scalar(0))};
  dot.depth.at<float>(2, 5) = 2;
  settings.thickness = 0.1;
  const GaussianCloud alone = spawn_gaussians(dot, camera, nullptr, settings);
  REQUIRE(alone.size() == 1);
  CHECK(alone.log_scales[0].z() == alone.log_scales[0].x());
}

TEST_CASE("even and flat squares of pixels give birth to one Gaussian, with their mean and their footprint") {
  Frame frame = wall(2);
  frame.colour.at<cv::Vec3b>(0, 0) = cv::Vec3b(255, 118, 10);  // within what counts as even
  const Camera camera{kIntrinsics};
  const GaussianCloud cloud = spawn_gaussians(frame, camera, nullptr, {});
  // 8 x 6 pixels: two squares of four, and below them four of two.
  REQUIRE(cloud.size() == 6);
  CHECK(cloud.means[0].isApprox(Eigen::Vector3f(2 * (1.5f - 3.5f) / 10, 2 * (1.5f - 2.5f) / 10, 2)));
  CHECK(std::exp(cloud.log_scales[0].x()) == doctest::Approx(4 * 0.2));
  CHECK(std::exp(cloud.log_scales[5].x()) == doctest::Approx(2 * 0.2));
  CHECK(0.5 + 0.28209479177387814 * cloud.sh[1] == doctest::Approx((15 * 128 + 118) / 16.0 / 255));
}

TEST_CASE("a square that is no surface of one colour falls apart, and each pixel is born once") {
  const auto sizes = [](const Frame& frame) {
    std::vector<uint8_t> wanted(48, 1);
    wanted[47] = 0;
    std::vector<int> count(5);
    std::vector<int> born(48);
    for (const BirthCell& cell : birth_cells(frame, wanted, 4)) {
      ++count[cell.size];
      for (int v = cell.v; v < cell.v + cell.size; ++v)
        for (int u = cell.u; u < cell.u + cell.size; ++u) ++born[8 * v + u];
    }
    for (std::size_t i = 0; i < born.size(); ++i) CHECK(born[i] == wanted[i]);
    return count;
  };
  CHECK(sizes(wall(2)) == std::vector{0, 3, 3, 0, 2});
  Frame coloured = wall(2);
  coloured.colour.at<cv::Vec3b>(1, 1) = cv::Vec3b(255, 100, 0);
  CHECK(sizes(coloured) == std::vector{0, 7, 6, 0, 1});
  Frame stepped = wall(2);
  stepped.depth.colRange(5, 8).setTo(2.5f);
  CHECK(sizes(stepped) == std::vector{0, 15, 4, 0, 1});
  Frame bent = wall(4);
  bent.depth.at<float>(0, 0) = 4.045f;  // by more than a hundredth of its depth
  CHECK(sizes(bent)[4] == 1);
  bent.depth.at<float>(0, 0) = 4.035f;
  CHECK(sizes(bent)[4] == 2);
}

TEST_CASE("images of any size are divided, empty ones too") {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 5), cv::Size(17, 2)}) {
    Frame frame;
    frame.colour = cv::Mat(size, CV_8UC3, cv::Scalar(9, 9, 9));
    frame.depth = cv::Mat(size, CV_32FC1, cv::Scalar(1));
    int pixels = 0;
    for (const BirthCell& cell : birth_cells(frame, std::vector<uint8_t>(frame.depth.total(), 1), 4))
      pixels += cell.size * cell.size;
    CHECK(pixels == size.area());
    CHECK(birth_cells(frame, std::vector<uint8_t>(frame.depth.total()), 4).empty());
  }
}
