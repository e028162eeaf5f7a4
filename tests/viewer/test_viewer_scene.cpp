// The lines over a picture of the map.
#include "engine/viewer/viewer_scene.h"

#include <doctest/doctest.h>

using namespace surefield;

namespace {

StampedPose keyframe_at(double x) {
  StampedPose pose{.timestamp = x};
  pose.camera_to_world.translation() = Eigen::Vector3d(x, 0, 0);
  return pose;
}

constexpr OverlayChoice kLoopsAlone{
    .trajectory = false, .truth = false, .keyframes = false, .window = false, .camera = false};

}  // namespace

TEST_CASE("a loop is a line between its keyframes, as far as both are known") {
  ViewerScene scene;
  scene.keyframes = {keyframe_at(0), keyframe_at(1), keyframe_at(2)};
  scene.loops = {{0, 2}, {1, 3}, {-1, 1}};
  const std::vector<Line> lines = lines_of(scene, kLoopsAlone);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].from == Eigen::Vector3f(0, 0, 0));
  CHECK(lines[0].to == Eigen::Vector3f(2, 0, 0));
  OverlayChoice none = kLoopsAlone;
  none.loops = false;
  CHECK(lines_of(scene, none).empty());
}
