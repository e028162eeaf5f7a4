// What feed() promises: what an error changes, what may be read when, who is told of poses that change.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "engine/sources/frame_stream.h"
#include "engine/types/error.h"
#include "tests/slam/office.h"

using namespace surefield;
using namespace surefield::testing;

namespace {

/// Describes an image by a few of its pixels, and throws at the calls of these numbers.
class FailingDescriptor : public ImageDescriptor {
 public:
  explicit FailingDescriptor(std::vector<int> failing = {}) : failing_(std::move(failing)) {}

  Eigen::VectorXf describe(const cv::Mat& rgb) override {
    if (std::find(failing_.begin(), failing_.end(), calls_++) != failing_.end())
      throw InputError("the descriptor fails");
    cv::Mat small;
    cv::resize(rgb, small, {4, 3}, 0, 0, cv::INTER_AREA);
    Eigen::VectorXf descriptor(small.rows * small.cols);
    for (int i = 0; i < descriptor.size(); ++i)
      descriptor[i] = static_cast<float>(small.at<cv::Vec3b>(i / small.cols, i % small.cols)[1]) + 1;
    return descriptor.normalized();
  }

 private:
  std::vector<int> failing_;
  int calls_ = 0;
};

/// A descriptor whose vectors grow.
class GrowingDescriptor : public ImageDescriptor {
 public:
  Eigen::VectorXf describe(const cv::Mat&) override { return Eigen::VectorXf::Unit(++length_, 0); }

 private:
  int length_ = 1;
};

Slam make_slam(const SlamSettings& settings = quick_settings(),
               std::unique_ptr<ImageDescriptor> descriptor = nullptr) {
  return Slam(settings, office_camera(), engine_options(), std::move(descriptor));
}

/// Settings with which the next keyframe ends with an error in the middle of mapping.
SlamSettings impossible_settings() {
  SlamSettings settings = quick_settings();
  settings.mapping_iterations = -1;
  return settings;
}

}  // namespace

TEST_CASE("a frame that fails before mapping was never fed, wherever it fails") {
  const std::vector<Frame>& frames = office_frames();
  Slam failing = make_slam(quick_settings(), std::make_unique<FailingDescriptor>(std::vector{0, 2, 3}));
  CHECK_THROWS_AS(failing.feed(frames[0]), InputError);
  CHECK(failing.usable());
  CHECK(failing.trajectory().empty());
  for (int i = 0; i < 3; ++i) failing.feed(frames[i]);
  const Trajectory before = failing.trajectory();
  CHECK_THROWS_WITH_AS(failing.feed(frames[3]), "the descriptor fails", InputError);
  CHECK_THROWS_AS(failing.feed(frames[7]), InputError);
  CHECK_THROWS_AS(failing.feed(resize_frame(frames[3], 0.5)), UsageError);
  Frame untimed = frames[3];
  untimed.depth_after = NAN;
  CHECK_THROWS_AS(failing.feed(untimed), UsageError);
  CHECK_THROWS_AS(failing.feed(frames[3], [](const FrameReport&) { throw UsageError("not now"); }),
                  UsageError);
  CHECK(failing.usable());
  CHECK(failing.reports().size() == 3);
  REQUIRE(failing.trajectory().size() == 3);
  CHECK(failing.trajectory()[2].camera_to_world.matrix() == before[2].camera_to_world.matrix());
  CHECK(failing.keyframes().size() == 1);
}

TEST_CASE("after a frame that failed the run gives the bits of one that never saw it") {
  const std::vector<Frame>& frames = office_frames();
  Slam failing = make_slam(quick_settings(), std::make_unique<FailingDescriptor>(std::vector{1, 3}));
  Slam other = make_slam(quick_settings(), std::make_unique<FailingDescriptor>());
  for (int i : {0, 1, 2}) {
    failing.feed(frames[i]);
    other.feed(frames[i]);
  }
  CHECK_THROWS_AS(failing.feed(frames[3]), InputError);
  for (int i : {4, 5}) {
    CHECK(failing.feed(frames[i]).keyframe == (i == 4));
    other.feed(frames[i]);
  }
  CHECK_THROWS_AS(failing.finish(), InputError);
  CHECK(failing.usable());
  failing.finish();
  other.finish();
  CHECK(failing.keyframes().size() == 3);
  CHECK(same_results(failing, other));
  CHECK(failing.engine_report().validation_messages.empty());
}

TEST_CASE("descriptors of different lengths are refused before they can do harm") {
  Slam slam = make_slam(quick_settings(), std::make_unique<GrowingDescriptor>());
  for (int i : {0, 1, 2}) slam.feed(office_frames()[i]);
  CHECK_THROWS_AS(slam.feed(office_frames()[3]), UsageError);
  CHECK(slam.usable());
}

TEST_CASE("an error in the middle of mapping ends the run, which keeps what there is and says why") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  for (int i : {0, 1, 2}) slam.feed(frames[i]);
  const std::size_t gaussians = slam.map().size();
  slam.change(impossible_settings());
  std::string cause;
  try {
    slam.feed(frames[3]);
  } catch (const std::exception& error) {
    cause = error.what();
  }
  REQUIRE_FALSE(cause.empty());
  CHECK_FALSE(slam.usable());
  const auto names_cause = [&](auto call) {
    try {
      call();
    } catch (const StateError& error) {
      return std::string(error.what()).find(cause) != std::string::npos;
    }
    return false;
  };
  CHECK(names_cause([&] { slam.feed(frames[4]); }));
  CHECK(names_cause([&] { slam.finish(); }));
  CHECK(slam.trajectory().size() == 4);
  CHECK(slam.reports().size() == 4);
  CHECK(slam.keyframes().size() == 2);
  CHECK(slam.window() == std::vector{0});
  CHECK(slam.map().size() >= gaussians);
  CHECK(slam.render({office_camera(), Pose::Identity()}).width == office_camera().width);
}

TEST_CASE("after the end no frame may be fed, and ending twice is no error") {
  Slam slam = make_slam();
  slam.feed(office_frames()[0]);
  CHECK(slam.usable());
  slam.finish();
  slam.finish();
  CHECK_FALSE(slam.usable());
  CHECK_THROWS_AS(slam.feed(office_frames()[1]), StateError);
  CHECK(slam.reports().size() == 1);
}

TEST_CASE("the pose is told before mapping, and by then the frame can be read") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  for (int i = 0; i < 4; ++i) {
    std::optional<FrameReport> told;
    const FrameReport report = slam.feed(frames[i], [&](const FrameReport& tracked) {
      told = tracked;
      CHECK(slam.trajectory().size() == static_cast<std::size_t>(i + 1));
      CHECK(slam.reports().back().index == frames[i].index);
      CHECK(slam.keyframes().size() == static_cast<std::size_t>(i > 0));
      CHECK_THROWS_AS(slam.feed(frames[i]), UsageError);
      CHECK_THROWS_AS(slam.finish(), UsageError);
      CHECK_THROWS_AS(slam.change(quick_settings()), UsageError);
    });
    REQUIRE(told);
    CHECK(told->mapping_iterations == 0);
    CHECK(told->keyframe == report.keyframe);
    CHECK(told->world_to_camera.matrix() == report.world_to_camera.matrix());
    CHECK(report.keyframe == (i % 3 == 0));
    CHECK((report.mapping_iterations > 0) == report.keyframe);
  }
}

TEST_CASE("the revision counts the calls that have changed poses that were told before") {
  const std::vector<Frame>& frames = office_frames();
  SlamSettings settings = quick_settings();
  for (const double rate : {0.0, 1e-3}) {
    settings.mapping.rate_pose_translation = rate;
    Slam slam = make_slam(settings);
    std::vector<uint64_t> told;
    slam.on_revision([&](uint64_t revision) {
      told.push_back(revision);
      CHECK(slam.revision() == revision);
      CHECK_THROWS_AS(slam.finish(), UsageError);
    });
    for (int i = 0; i < 6; ++i) slam.feed(frames[i]);
    // The window's oldest keyframe is held, and the newest one's pose had not been told.
    CHECK(slam.revision() == 0);
    const Trajectory before = slam.trajectory();
    slam.feed(frames[6]);
    const Trajectory after = slam.trajectory();
    CHECK((before[3].camera_to_world.matrix() != after[3].camera_to_world.matrix()) == (rate > 0));
    CHECK((before[4].camera_to_world.matrix() != after[4].camera_to_world.matrix()) == (rate > 0));
    CHECK(slam.revision() == (rate > 0 ? 1 : 0));
    slam.feed(frames[7]);
    CHECK(slam.revision() == (rate > 0 ? 1 : 0));
    slam.finish();
    CHECK(slam.revision() == (rate > 0 ? 2 : 0));
    CHECK(told == (rate > 0 ? std::vector<uint64_t>{1, 2} : std::vector<uint64_t>{}));
  }
}
