#include <doctest/doctest.h>

#include <cmath>

#include "engine/gpu/recorder.h"
#include "engine/splat/rasteriser.h"
#include "shaders/shared/align_halve.h"
#include "shaders/shared/align_points.h"
#include "tests/splat/on_device.h"

// What Gauss-Newton tracking makes of images before it aligns them.

using namespace surefield;
using testing::on_device;

TEST_CASE(
    "half an image is the mean of four pixels, and of the depths on the nearest surface; hidden ones hide "
    "it") {
  gpu::Device& device = testing::device();
  const gpu::Pass<passes::align_halve> pass(device, 64);
  // 9 x 3 pixels: the last column and row have no partner.
  std::vector<glsl::vec2> source(27, {0.5f, 9.0f});
  source[0] = {0.1f, 2.0f}, source[1] = {0.2f, 2.05f}, source[9] = {0.3f, 0.0f}, source[10] = {0.4f, 3.0f};
  source[2] = {1, 0}, source[3] = {1, 0}, source[11] = {1, 0}, source[12] = {0, 0};
  source[4] = {1, -1}, source[5] = {1, 0}, source[13] = {1, 0}, source[14] = {1, -1};
  source[6] = {1, -1}, source[7] = {1, 4}, source[15] = {1, 0}, source[16] = {1, -1};
  const auto large = on_device("source", source);
  const gpu::Array<glsl::vec2> small(device, "image", 4);
  gpu::Recorder recorder(device);
  recorder.dispatch(pass, 1, {.source = large, .image = small}, {.width = 4, .height = 1, .source_width = 9});
  recorder.submit();
  const auto got = small.download(4);
  CHECK(got[0].x == doctest::Approx(0.25));
  CHECK(got[0].y == doctest::Approx(2.025));
  CHECK(got[1].x == doctest::Approx(0.75));
  CHECK(got[1].y == 0);
  CHECK(got[2].y == -1);
  CHECK(got[3].y == 4);
}

TEST_CASE(
    "normals of a plane are the plane's at every level; none at the border and across edges, and nothing "
    "where it is hidden") {
  gpu::Device& device = testing::device();
  const gpu::Pass<passes::align_points> pass(device, 64);
  const Intrinsics full{.width = 64, .height = 48, .fx = 60, .fy = 55, .cx = 30, .cy = 25};
  const Eigen::Vector3d normal = Eigen::Vector3d(0.1, -0.08, -1).normalized();
  for (uint32_t level : {0u, 1u, 2u}) {
    CAPTURE(level);
    const Intrinsics k = full.scaled(std::pow(0.5, level));
    std::vector<glsl::vec2> image;
    for (int i = 0; i < k.width * k.height; ++i) {
      const Eigen::Vector3d ray((i % k.width - k.cx) / k.fx, (i / k.width - k.cy) / k.fy, 1);
      image.push_back({0.5f, static_cast<float>(-2.0 / normal.dot(ray))});
    }
    const int hole = 5 * k.width + 4;
    image[hole].y = 0;
    const int hidden = 7 * k.width + 9;
    image[hidden].y = -1;
    const auto rendered = on_device("image", image);
    const auto camera = on_device("camera", std::vector{to_device(Camera{full})});
    const gpu::Array<glsl::AlignPoint> points(device, "points", image.size());
    gpu::Recorder recorder(device);
    recorder.dispatch(pass, pass.groups(image.size()),
                      {.camera = camera, .image = rendered, .points = points},
                      {.width = static_cast<uint32_t>(k.width),
                       .height = static_cast<uint32_t>(k.height),
                       .level = level,
                       .unknown = 1.5f});
    recorder.submit();
    const auto got = points.download(image.size());
    for (int i = 0; i < k.width * k.height; ++i) {
      const int u = i % k.width, v = i / k.width;
      const bool border = u == 0 || v == 0 || u == k.width - 1 || v == k.height - 1;
      const bool near_hole = std::abs(u - 4) + std::abs(v - 5) <= 1 || std::abs(u - 9) + std::abs(v - 7) <= 1;
      CHECK(got[i].depth == (i == hidden ? 0 : image[i].y > 0 ? image[i].y : -1.5f));
      const glsl::vec3& n = got[i].normal;
      const double want = border || near_hole ? 0 : 1;
      CHECK(Eigen::Vector3d(n.x, n.y, n.z).dot(normal) == doctest::Approx(want).epsilon(1e-4));
    }
  }
}
