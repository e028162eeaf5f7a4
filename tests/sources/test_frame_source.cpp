// Sources that give each frame once, and what a recording is as one of them.
#include "engine/sources/frame_source.h"

#include <doctest/doctest.h>

#include <stdexcept>

#include "engine/sources/frame_stream.h"
#include "tests/sources/fake_recording.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::FakeRecording;
using test::input_error;

namespace {

/// A camera as its driver gives it: nobody knows how many frames there will be, and none comes twice. Frame i
/// is filled with i.
class LiveCamera : public FrameSource {
 public:
  explicit LiveCamera(int last) : last_(last) {}
  std::string name() const override { return "camera 1"; }
  std::string format() const override { return "live"; }
  Intrinsics intrinsics() const override { return {8, 6, 10, 10, 3.5, 2.5}; }
  std::optional<int> size() const override { return std::nullopt; }
  std::vector<std::string> warnings() const override { return {"the lens is dirty"}; }
  Pose tracked_to_reference() const override { return Pose(Eigen::Translation3d(0.1, 0, 0)); }
  const std::vector<SkippedFrame>& problems() const override { return problems_; }

  std::optional<Frame> next() override {
    while (index_ < last_) {
      const int i = ++index_;
      ++asked;
      if (i == unplugged) throw std::runtime_error("the camera is gone");
      if (i != torn && i != also_torn)
        return Frame{i, i / 30.0, cv::Mat(6, 8, CV_8UC3, cv::Scalar::all(i)),
                     cv::Mat(6, 8, CV_32FC1, cv::Scalar(i))};
      problems_.push_back({i, "torn"});
    }
    return std::nullopt;
  }

  int torn = -1;
  int also_torn = -1;
  int unplugged = -1;
  int asked = 0;

 private:
  int last_;
  int index_ = -1;
  std::vector<SkippedFrame> problems_;
};

std::vector<int> indices(FrameSource& source) {
  std::vector<int> result;
  while (const auto frame = source.next()) {
    CHECK(frame->colour.at<cv::Vec3b>(0, 0)[0] == frame->index);
    CHECK(frame->colour.cols == source.intrinsics().width);
    CHECK(frame->depth.rows == source.intrinsics().height);
    result.push_back(frame->index);
  }
  return result;
}

}  // namespace

TEST_CASE("a live source streams with start, stride and scale, to its end") {
  LiveCamera camera(10);
  FrameStream stream(camera, {.start = 1, .stride = 3, .scale = 0.5});
  CHECK_FALSE(stream.size());
  CHECK(stream.recording() == nullptr);
  CHECK(stream.name() == "camera 1");
  CHECK(stream.format() == "live");
  CHECK(stream.warnings() == camera.warnings());
  CHECK(stream.tracked_to_reference().isApprox(camera.tracked_to_reference()));
  CHECK(stream.intrinsics().width == 4);
  CHECK(stream.intrinsics().fx == 5);
  CHECK(indices(stream) == std::vector<int>{1, 4, 7, 10});
  CHECK_FALSE(stream.next());
  CHECK(stream.problems().empty());
}

TEST_CASE("what a live source passes over is a problem of the stream where it was selected") {
  LiveCamera camera(8);
  camera.torn = 3;
  camera.also_torn = 4;
  FrameStream stream(camera, {.stride = 2});
  CHECK(stream.next()->index == 0);
  CHECK(stream.next()->index == 2);
  CHECK(stream.problems().empty());
  CHECK(indices(stream) == std::vector<int>{6, 8});
  REQUIRE(stream.problems().size() == 1);
  CHECK(stream.problems()[0].index == 4);
  CHECK(stream.problems()[0].reason == "torn");
}

TEST_CASE("a live source is not asked for more than there is to stream") {
  LiveCamera camera(1000);
  camera.torn = 2;
  {
    FrameStream stream(camera, {.stride = 2, .frames = 3});
    CHECK(indices(stream) == std::vector<int>{0, 4});
    CHECK(stream.problems().size() == 1);
  }
  CHECK(camera.asked == 5);
  { const FrameStream left_alone(camera, {.ahead = 3}); }
  CHECK(camera.asked <= 5 + 4);
}

TEST_CASE("what stops a live source reaches the consumer after the frames before it") {
  LiveCamera camera(10);
  camera.unplugged = 2;
  FrameStream stream(camera, {});
  CHECK(stream.next()->index == 0);
  CHECK(stream.next()->index == 1);
  CHECK_THROWS_AS(stream.next(), std::runtime_error);
}

TEST_CASE(
    "a live source may end before the first selected frame; a selection that makes no sense is refused") {
  LiveCamera camera(3);
  FrameStream stream(camera, {.start = 100});
  CHECK_FALSE(stream.next());
  CHECK(contains(input_error([&] { FrameStream(camera, {.start = -1}); }), "start is -1"));
  CHECK(contains(input_error([&] { FrameStream(camera, {.stride = 0}); }), "stride"));
}

TEST_CASE("a recording gives its frames one after the other, and any of them again") {
  FakeRecording recording(5);
  recording.missing = 2;
  FrameSource& source = recording;
  CHECK(source.size() == 5);
  CHECK(source.recording() == &recording);
  CHECK(indices(source) == std::vector<int>{0, 1, 3, 4});
  REQUIRE(source.problems().size() == 1);
  CHECK(source.problems()[0].index == 2);
  CHECK(source.problems()[0].reason == "file is missing");
  CHECK_FALSE(source.next());
  CHECK(source.recording()->load(1).frame->index == 1);
}

TEST_CASE("of a recording that is given as any source, only the selected frames are loaded") {
  FakeRecording recording(10);
  FrameSource& source = recording;
  FrameStream stream(source, {.start = 1, .stride = 4});
  CHECK(stream.size() == 3);
  CHECK(stream.recording() == &recording);
  CHECK(indices(stream) == std::vector<int>{1, 5, 9});
  CHECK(recording.loads == 3);
}

TEST_CASE("a stream of a stream selects among what the first one selects") {
  FakeRecording recording(12);
  recording.missing = 4;
  FrameStream even(recording, {.stride = 2});
  FrameStream stream(even, {.start = 1, .stride = 2});
  CHECK(stream.size() == 3);
  CHECK(indices(stream) == std::vector<int>{2, 6, 10});
  CHECK(stream.problems().empty());
  CHECK(stream.recording()->load(7).frame->index == 7);
}

TEST_CASE("poses of the tracked camera and of the reference camera turn into each other") {
  const LiveCamera camera(1);
  Trajectory tracked(2);
  tracked[1].camera_to_world = Pose(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  const Trajectory reference = of_reference_camera(tracked, camera);
  CHECK(reference[0].camera_to_world.translation().x() == doctest::Approx(-0.1));
  const Trajectory back = of_tracked_camera(reference, camera);
  for (std::size_t i : {0, 1}) CHECK(back[i].camera_to_world.isApprox(tracked[i].camera_to_world, 1e-12));
}

TEST_CASE("the depth of a frame comes after its colour by its stamps, unless these are of two clocks") {
  struct Stamped : test::FakeRecording {
    Stamped() : FakeRecording(4) {}
    double depth_timestamp(int i) const override { return i + 0.05 * i * i; }
  } const recording;
  CHECK(recording.depth_after(0) == 0);
  CHECK(recording.depth_after(1) == doctest::Approx(0.05));
  CHECK(recording.depth_after(2) == 0);
  CHECK(test::FakeRecording(2).depth_after(1) == 0);
}
