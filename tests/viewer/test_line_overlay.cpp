#include <doctest/doctest.h>

#include <cmath>

#include "engine/viewer/overlays.h"
#include "engine/viewer/view_painter.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

const Camera kCamera{{.width = 90, .height = 61, .fx = 70, .fy = 75, .cx = 44, .cy = 31}};

/// A wall 2 m ahead, seen by the left half of the image, of red Gaussians.
GaussianCloud wall() {
  GaussianCloud cloud;
  for (float y = -1.4f; y < 1.4f; y += 0.05f)
    for (float x = -1.6f; x < 0; x += 0.05f) {
      cloud.resize(cloud.size() + 1);
      cloud.means.back() = {x, y, 2};
      cloud.log_scales.back().setConstant(std::log(0.04f));
      cloud.opacity_logits.back() = 5;
    }
  cloud.sh.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.sh.insert(cloud.sh.end(), {1.7725f, -1.7725f, -1.7725f});
  return cloud;
}

/// What the definition says of one pixel over `picture`: every line, taken as many points of the world.
Eigen::Vector3d drawn(const std::vector<Line>& lines, int u, int v, Eigen::Vector3d colour,
                      double map_depth) {
  for (const Line& line : lines) {
    constexpr int kPoints = 4000;
    double least = INFINITY, depth = 0;
    for (int i = 0; i <= kPoints; ++i) {
      const Eigen::Vector3d p =
          (line.from + static_cast<float>(i) / kPoints * (line.to - line.from)).cast<double>();
      if (p.z() < 0.01) continue;
      const Intrinsics& k = kCamera.intrinsics;
      const double off = std::hypot(k.fx * p.x() / p.z() + k.cx - u, k.fy * p.y() / p.z() + k.cy - v);
      if (off < least) depth = p.z();
      least = std::min(least, off);
    }
    const bool hidden = !line.on_top && map_depth > 0 && depth > map_depth / 0.98;
    const double alpha =
        std::clamp(line.width / 2 + 0.5 - least, 0.0, 1.0) * line.colour[3] * (hidden ? 0.2 : 1);
    colour = (1 - alpha) * colour + alpha * 255 * line.colour.head<3>().cast<double>();
  }
  return colour;
}

}  // namespace

TEST_CASE("lines cover what they should, are cut behind the camera and faint behind the map") {
  const std::vector<Line> lines = {
      {{-1.2f, -0.5f, 3}, {1.2f, 0.6f, 3}, {0, 1, 0, 1}, 3},           // behind the wall, then beside it
      {{-0.6f, 0.3f, 1.5f}, {0.2f, -0.4f, 1.2f}, {0, 0, 1, 0.5f}, 4},  // before it, half transparent
      {{-1, 0.4f, 3}, {1, 0.4f, 3}, {1, 1, 1, 1}, 1, true},            // behind it, but on top
      {{0.1f, 0.05f, -1}, {0.3f, 0.3f, 1.5f}, {1, 1, 0, 1}, 2},        // from behind the camera
      {{-1, 0, -3}, {1, 0, -3}, {1, 1, 1, 1}, 9},                      // all of it behind the camera
      {{50, 0, 4}, {50, 9, 4}, {1, 1, 1, 1}, 9},                       // beside the image
  };
  ViewPainter painter(testing::device());
  painter.assign(wall());
  painter.paint(kCamera, {.background = {0.2f, 0.2f, 0.2f}, .checker = 0});
  const cv::Mat before = painter.picture();
  painter.paint(kCamera, {.background = {0.2f, 0.2f, 0.2f}, .checker = 0}, lines);
  const cv::Mat after = painter.picture();
  int changed = 0;
  for (int v = 0; v < 61; ++v)
    for (int u = 0; u < 90; ++u) {
      if (std::abs(u - 44) < 4) continue;  // the edge of the wall
      const cv::Vec3b was = before.at<cv::Vec3b>(v, u), is = after.at<cv::Vec3b>(v, u);
      const Eigen::Vector3d want =
          drawn(lines, u, v, {double(was[0]), double(was[1]), double(was[2])}, u < 44 ? 2 : 0);
      CAPTURE(u);
      CAPTURE(v);
      CHECK((want - Eigen::Vector3d(is[0], is[1], is[2])).cwiseAbs().maxCoeff() < 8);
      changed += was != is;
    }
  CHECK(changed > 300);
}

TEST_CASE("tiles hold every line that touches them, in order") {
  const std::vector<glsl::LineSegment> segments = {{.from = {-20, 4}, .to = {40, 4}, .half_width = 1},
                                                   {.from = {12, 10}, .to = {12, 10}, .half_width = 3}};
  const LineBins bins = bin_lines(segments, {32, 16});
  std::vector<int> lines_of_tile(8, 0);
  for (const glsl::LineTile& tile : bins.tiles) {
    REQUIRE(tile.x < 4);
    REQUIRE(tile.y < 2);
    lines_of_tile[4 * tile.y + tile.x] = static_cast<int>(tile.end - tile.begin);
  }
  CHECK(lines_of_tile == std::vector{1, 2, 1, 1, 0, 1, 0, 0});
}

TEST_CASE("a frustum's edges run from the camera to the corners of its image") {
  Camera camera = kCamera;
  camera.world_to_camera =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()) * Eigen::Translation3d(0.3, -0.2, 0.1);
  std::vector<Line> lines;
  add_frustum(lines, camera, 0.5, {.width = 3});
  REQUIRE(lines.size() == 8);
  const Eigen::Vector3d corner =
      camera.world_to_camera * lines[4].to.cast<double>();  // the third: right below
  CHECK(corner.z() == doctest::Approx(0.5));
  CHECK(70 * corner.x() / corner.z() + 44 == doctest::Approx(89.5));
  CHECK(75 * corner.y() / corner.z() + 31 == doctest::Approx(60.5));
  CHECK((camera.world_to_camera * lines[4].from.cast<double>()).norm() < 1e-6);
}

TEST_CASE("a path is interrupted where a pose is unknown") {
  Trajectory trajectory(5);
  for (int i = 0; i < 5; ++i) trajectory[i].camera_to_world.translation() = Eigen::Vector3d(i, 0, 0);
  trajectory[2].camera_to_world.translation().x() = NAN;
  std::vector<Line> lines;
  add_path(lines, trajectory, {});
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].to.x() == 1);
  CHECK(lines[1].from.x() == 3);
}
