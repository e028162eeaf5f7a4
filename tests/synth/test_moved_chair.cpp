#include "engine/synth/moved_chair.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "engine/synth/synthetic_recording.h"
#include "engine/types/error.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

/// Everything is seen but from one frame to before another.
VisibleShares hidden_between(const Scene& scene, int from, int to) {
  return [&scene, from, to](int frame) {
    return std::vector<double>(scene.objects.size(), frame >= from && frame < to ? 0 : 0.1);
  };
}

/// How far each object's first body is from where it was, metres.
std::vector<double> moves(const Scene& before, const Scene& after) {
  std::vector<double> metres(before.objects.size(), 0);
  for (std::size_t i = 0; i < before.shapes.size(); ++i) {
    double& most = metres[static_cast<std::size_t>(before.shapes[i].object)];
    most = std::max(
        most, (before.shapes[i].shape_to_world.translation() - after.shapes[i].shape_to_world.translation())
                  .norm());
  }
  return metres;
}

double difference(const SyntheticRecording& one, const SyntheticRecording& other, int frame) {
  return cv::norm(one.load(frame).frame->depth, other.load(frame).frame->depth, cv::NORM_L1);
}

}  // namespace

TEST_CASE("a chair is moved to where there is room, in the middle of the time in which it is not seen") {
  for (const char* name : {"office", "apartment", "twins"}) {
    for (const uint32_t seed : {1u, 2u, 3u}) {
      CAPTURE(name);
      CAPTURE(seed);
      const Scene scene = make_scene(name, seed);
      const MovedChair moved = move_chair(scene, 200, hidden_between(scene, 50, 150));
      CHECK(moved.frame == 97);  // between 45 and 150: every fifth frame is looked at
      const std::string what = scene.objects[static_cast<std::size_t>(moved.object)];
      CHECK((what == "chair" || what == "swivel chair"));
      const std::vector<double> metres = moves(scene, moved.scene);
      for (std::size_t i = 0; i < metres.size(); ++i) {
        if (static_cast<int>(i) == moved.object) {
          CHECK(metres[i] > 0.2);
          CHECK(metres[i] < 1);
        } else {
          CHECK(metres[i] == 0);
        }
      }
      // Its feet stand on the floor as before.
      double lowest[2] = {1e9, 1e9};
      for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        if (scene.shapes[i].object != moved.object) continue;
        const double half = scene.shapes[i].half_size.z();
        lowest[0] = std::min(lowest[0], scene.shapes[i].shape_to_world.translation().z() - half);
        lowest[1] = std::min(lowest[1], moved.scene.shapes[i].shape_to_world.translation().z() - half);
      }
      CHECK(lowest[0] == doctest::Approx(lowest[1]));
    }
  }
}

TEST_CASE("a chair that is not seen again, or none, is told with the way out") {
  const Scene office = make_scene("office", 1);
  for (const auto& [from, to] : {std::pair(50, 200), {0, 150}, {50, 60}})
    CHECK_THROWS_WITH_AS(move_chair(office, 200, hidden_between(office, from, to)),
                         doctest::Contains("a path that comes back"), InputError);
  const Scene hall = make_scene("hall", 1);
  CHECK_THROWS_AS(move_chair(hall, 200, hidden_between(hall, 50, 150)), InputError);
}

TEST_CASE("a recording shows the chair where it stood, and elsewhere when the camera has come round") {
  SynthSettings settings{.path = "turn", .width = 64, .height = 48, .frames = 300, .seed = 2};
  const SyntheticRecording still(testing::device_options(), settings);
  settings.moved_chair = true;
  const SyntheticRecording moved(testing::device_options(), settings);
  REQUIRE(moved.chair_moved_at());
  CHECK_FALSE(still.chair_moved_at());
  const int at = *moved.chair_moved_at();
  CHECK(at > 15);
  CHECK(at < 285);
  CHECK(difference(still, moved, 0) == 0);
  CHECK(difference(still, moved, at - 1) == 0);
  CHECK(difference(still, moved, at) == 0);  // nobody looks
  double later = 0;
  for (int i = at; i < 300; i += 5) later = std::max(later, difference(still, moved, i));
  CHECK(later > 3);  // metres, over the image: ten pixels by 30 cm
}
