#include "engine/viewer/view_painter.h"

#include <doctest/doctest.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "engine/types/error.h"
#include "tests/support/device.h"
#include "tests/viewer/reference_picture.h"

using namespace surefield;
using reference::SceneKind;

namespace {

/// A picture of noise, the same each time.
cv::Mat noise_image(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

FrameView view_of(const cv::Mat& colour, const std::vector<float>& depth) {
  return {.width = colour.cols, .height = colour.rows, .colour = colour.data, .depth = depth.data()};
}

/// The largest difference of a channel to the nearest version of a pixel.
double difference(const cv::Vec3b& got, const std::vector<Eigen::Vector3d>& versions) {
  double least = 255;
  for (const Eigen::Vector3d& want : versions)
    least = std::min(least, (Eigen::Vector3d(got[0], got[1], got[2]) - want).cwiseAbs().maxCoeff());
  return least;
}

void compare_with_reference(const reference::Scene& scene, const ViewSettings& settings) {
  const Intrinsics& k = scene.camera.intrinsics;
  const cv::Mat sensor = noise_image(k.width, k.height);
  ViewPainter painter(testing::device());
  painter.assign(scene.cloud);
  painter.set_sensor(view_of(sensor, scene.depth), k);
  painter.paint(scene.camera, settings);
  const cv::Mat got = painter.picture();
  const reference::Picture want = reference::paint(scene, settings, sensor);
  REQUIRE(got.size() == cv::Size(k.width, k.height));
  std::size_t compared = 0;
  for (int i = 0; i < k.width * k.height; ++i) {
    if (want.edge[i]) continue;
    ++compared;
    CAPTURE(i);
    CHECK(difference(got.at<cv::Vec3b>(i), want.pixels[i]) < 1);
  }
  CHECK(compared * 10 > want.pixels.size() * 5);
}

}  // namespace

TEST_CASE("every mode paints what its definition says") {
  for (const ViewModeInfo& info : view_modes()) {
    const std::string name = info.name;
    CAPTURE(name);
    for (SceneKind kind : {SceneKind::mixed, SceneKind::anisotropic}) {
      reference::Scene scene = reference::random_scene(5, 120, {.kind = kind, .sh_degree = 1});
      for (std::size_t i = 0; i < scene.cloud.size(); ++i)
        scene.cloud.uncertainty[i] = 0.04f * static_cast<float>(i) / 120;
      compare_with_reference(scene, {.mode = info.mode,
                                     .background = {0.1f, 0.2f, 0.6f},
                                     .checker = 7,
                                     .depth_near = 0.5f,
                                     .depth_far = 4.5f,
                                     .error_far = 0.3f});
    }
  }
}

TEST_CASE("solids are whole in every tile, at the border and where opacity is low") {
  for (ViewMode mode : {ViewMode::Ellipsoids, ViewMode::Points})
    for (SceneKind kind :
         {SceneKind::isotropic_small, SceneKind::at_border, SceneKind::low_opacity, SceneKind::behind_camera})
      compare_with_reference(reference::random_scene(9, 80, {.kind = kind, .width = 61, .height = 43}),
                             {.mode = mode});
}

TEST_CASE("a view with other intrinsics shows the sensor's image where the sensor sees it") {
  const Intrinsics sensor_camera{.width = 40, .height = 30, .fx = 35, .fy = 36, .cx = 19, .cy = 15.5};
  const Intrinsics view{.width = 96, .height = 80, .fx = 70, .fy = 66, .cx = 45, .cy = 38};
  const cv::Mat sensor = noise_image(40, 30);
  ViewPainter painter(testing::device());
  painter.set_sensor(view_of(sensor, std::vector<float>(40 * 30, 1.0f)), sensor_camera);
  painter.paint({view}, {.mode = ViewMode::Sensor, .background = {1, 1, 1}, .checker = 0});
  const cv::Mat got = painter.picture();
  int outside = 0;
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < view.width; ++u) {
      const double x = (u - view.cx) / view.fx * sensor_camera.fx + sensor_camera.cx;
      const double y = (v - view.cy) / view.fy * sensor_camera.fy + sensor_camera.cy;
      const cv::Point at(static_cast<int>(std::floor(x + 0.5)), static_cast<int>(std::floor(y + 0.5)));
      const bool inside = cv::Rect(0, 0, 40, 30).contains(at);
      outside += !inside;
      // Exactly between two pixels, either may be taken.
      if (std::abs(x + 0.5 - std::round(x + 0.5)) < 1e-4 || std::abs(y + 0.5 - std::round(y + 0.5)) < 1e-4)
        continue;
      CHECK(got.at<cv::Vec3b>(v, u) == (inside ? sensor.at<cv::Vec3b>(at) : cv::Vec3b(255, 255, 255)));
    }
  CHECK(outside > 100);
}

TEST_CASE("an empty map is the background, and a mode that needs a frame says so") {
  ViewPainter painter(testing::device());
  const Camera camera{{.width = 20, .height = 10, .fx = 20, .fy = 20, .cx = 9.5, .cy = 4.5}};
  painter.paint(camera, {.background = {0, 0.6f, 1}, .checker = 0});
  CHECK(cv::norm(painter.picture(), cv::Mat(10, 20, CV_8UC3, cv::Scalar(0, 153, 255)), cv::NORM_INF) == 0);
  // In squares, every other one lighter: nothing that a map could hold.
  painter.paint(camera, {.background = {0.2f, 0.4f, 0.6f}, .checker = 5});
  const cv::Vec3b dark(51, 102, 153), light(66, 117, 168);
  for (int v = 0; v < 10; ++v)
    for (int u = 0; u < 20; ++u)
      CHECK(cv::norm(painter.picture().at<cv::Vec3b>(v, u), (u / 5 + v / 5) % 2 ? light : dark,
                     cv::NORM_INF) <= 1);
  CHECK_THROWS_AS(painter.paint(camera, {.mode = ViewMode::Error}), UsageError);
}

TEST_CASE("a picture does not depend on those painted before it") {
  const auto scene = reference::random_scene(3, 200);
  ViewPainter painter(testing::device());
  painter.assign(scene.cloud);
  Camera small = scene.camera;
  small.intrinsics = small.intrinsics.scaled(0.5);
  painter.paint(scene.camera, {});
  const cv::Mat first = painter.picture();
  painter.paint(small, {.mode = ViewMode::Ellipsoids});
  painter.paint(scene.camera, {.mode = ViewMode::Normals});
  painter.paint(scene.camera, {});
  CHECK(cv::norm(first, painter.picture(), cv::NORM_INF) == 0);
}

TEST_CASE("the modes have names of their own, by which they are found") {
  std::set<std::string> names;
  for (const ViewModeInfo& info : view_modes()) {
    names.insert(info.name);
    CHECK(find_view_mode(info.name) == info.mode);
    CHECK(info_of(info.mode).name == info.name);
  }
  CHECK(names.size() == 11);
  CHECK_FALSE(find_view_mode("no such mode"));
}
