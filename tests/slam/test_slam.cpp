#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "engine/eval/trajectory_metrics.h"
#include "engine/sources/frame_stream.h"
#include "engine/types/error.h"
#include "tests/slam/office.h"

using namespace surefield;
using namespace surefield::testing;

namespace {

struct Run {
  Trajectory trajectory;
  GaussianCloud map;
  std::vector<FrameReport> reports;
  Trajectory truth;
};

Run run(int frames, const SlamSettings& settings) {
  const SyntheticRecording recording = office(frames);
  FrameStream stream(recording, {});
  Slam slam(settings, stream.intrinsics(), engine_options());
  while (const auto frame = stream.next()) slam.feed(*frame);
  slam.finish();
  CHECK(slam.engine_report().validation_messages.empty());
  CHECK(slam.keyframes().size() ==
        static_cast<std::size_t>((frames + 2) / 3 + (frames % 3 != 1)));  // the last one too
  return {slam.trajectory(), slam.map(), slam.reports(), recording.ground_truth()};
}

}  // namespace

TEST_CASE("SLAM follows the synthetic office, and the same run gives the same bits") {
  const Run first = run(6, quick_settings());
  REQUIRE(first.trajectory.size() == 6);
  CHECK(evaluate_trajectory(first.trajectory, first.truth).ate.rmse < 0.01);
  CHECK(first.reports[0].keyframe);
  CHECK(first.reports.back().keyframe);
  CHECK(first.reports[3].keyframe);
  CHECK(first.reports[3].mapping_iterations == 10);
  CHECK_FALSE(first.reports[4].keyframe);
  for (const FrameReport& report : first.reports) CHECK_FALSE(report.lost());
  for (float logit : first.map.opacity_logits) REQUIRE(std::isfinite(logit));

  const Run second = run(6, quick_settings());
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(first.trajectory[i].camera_to_world.matrix() == second.trajectory[i].camera_to_world.matrix());
  CHECK(first.map.means == second.map.means);
  CHECK(first.map.sh == second.map.sh);
}

TEST_CASE("depth that was taken before or after colour is used for where the camera was then") {
  const SyntheticRecording recording = office(33);
  const auto error = [&](bool told) {
    Slam slam(quick_settings(), recording.intrinsics(), engine_options());
    for (int i = 2; i + 1 < recording.count(); i += 4) {
      Frame frame = *recording.load(i).frame;
      const Frame other = *recording.load(i % 8 == 2 ? i + 1 : i - 1).frame;
      frame.depth = other.depth;
      if (told) frame.depth_after = other.timestamp - frame.timestamp;
      slam.feed(frame);
    }
    return evaluate_trajectory(slam.trajectory(), recording.ground_truth()).ate.rmse;
  };
  CHECK(error(true) < 0.7 * error(false));
}

TEST_CASE("somebody who walks through the picture does not drag the camera along") {
  const auto error = [](bool somebody) {
    const SyntheticRecording recording(device_options(),
                                       {.width = 96, .height = 72, .frames = 400, .moving_object = somebody});
    Slam slam(quick_settings(), recording.intrinsics(), engine_options());
    double moved = 0;
    for (int i = 300; i < 350; i += 2) moved = std::max(moved, slam.feed(*recording.load(i).frame).moved);
    CHECK((moved > 0) == somebody);
    CHECK(moved < 0.5);
    return evaluate_trajectory(slam.trajectory(), recording.ground_truth()).ate.rmse;
  };
  const double alone = error(false), together = error(true);
  CHECK(together < 1.5 * alone + 5e-4);
}

TEST_CASE("settings that are changed count from the next frame on") {
  const SyntheticRecording recording = office(5);
  FrameStream stream(recording, {});
  SlamSettings settings = quick_settings();
  Slam slam(settings, stream.intrinsics(), engine_options());
  slam.feed(*stream.next());
  CHECK(slam.window() == std::vector{0});
  slam.feed(*stream.next());
  settings.keyframes.interval = 2;
  settings.mapping_iterations = 4;
  slam.change(settings);
  const FrameReport third = slam.feed(*stream.next());
  CHECK(third.keyframe);  // not after two more frames
  CHECK(third.mapping_iterations == 4);
  CHECK(slam.window() == std::vector{0, 1});
}

TEST_CASE("the keyframes of the window judge the map's Gaussians, unless told not to") {
  SlamSettings settings = quick_settings();
  settings.mapping_iterations = 2;
  settings.spawn.cell = 1;  // many
  // Below what the sensor itself can be off by, four deviations, nothing is uncertain.
  settings.sensor = DepthSensor::TimeOfFlight;
  for (const double above : {0.0, 1e-5}) {
    settings.mapping.uncertainty_above = above;
    const Run judged = run(2, settings);
    const std::vector<float>& uncertainty = judged.map.uncertainty;
    const auto high =
        std::count_if(uncertainty.begin(), uncertainty.end(), [](float u) { return u > 1e-9f; });
    CHECK((high > 1000) == (above > 0));
    CHECK((judged.reports.back().uncertain_gaussians > 1000) == (above > 0));
  }
}

TEST_CASE("a run on a small budget of device memory keeps to it, and its map is that of the whole run") {
  SlamSettings settings = quick_settings();
  settings.first_iterations = 20;
  settings.spawn.cell = 1;  // more than fit
  settings.map_device_mb = 3;
  settings.keyframes.near = 2;
  settings.densify.gradient_threshold = 1e6;  // what is split and cloned may go beyond the budget for a while
  const Run small = run(9, settings);
  CHECK(evaluate_trajectory(small.trajectory, small.truth).ate.rmse < 0.02);
  const FrameReport& last = small.reports.back();
  CHECK(small.map.size() == last.gaussians);
  CHECK(last.device_gaussians < last.gaussians);
  CHECK(last.device_gaussians <= 3000000 / 512);
  const Run again = run(9, settings);
  for (std::size_t i = 0; i < 9; ++i)
    CHECK(small.trajectory[i].camera_to_world.matrix() == again.trajectory[i].camera_to_world.matrix());
  CHECK(small.map.means == again.map.means);
}

TEST_CASE("the map keeps its exposure where the camera's changes, if it is told to") {
  const SyntheticRecording recording = office(4);
  const auto brightness_of_last = [&](bool exposure, double gain) {
    SlamSettings settings = quick_settings();
    settings.mapping_iterations = 40;
    settings.keyframes.exposure = exposure;
    settings.lost.loss_jump = 1e6;
    Slam slam(settings, recording.intrinsics(), engine_options());
    for (int i = 0; i < 4; ++i) {
      Frame frame = *recording.load(i).frame;
      if (i == 3) frame.colour.convertTo(frame.colour, -1, gain);
      slam.feed(frame);
    }
    CHECK(slam.reports()[3].keyframe);
    const RenderImages images = slam.render({recording.intrinsics(), slam.reports()[3].world_to_camera});
    return std::accumulate(images.colour.begin(), images.colour.end(), 0.0);
  };
  const double steady = brightness_of_last(false, 1);
  CHECK(brightness_of_last(true, 0.7) == doctest::Approx(steady).epsilon(0.02));
  CHECK(brightness_of_last(false, 0.7) < 0.95 * steady);
}

TEST_CASE("a run whose windows are chosen by images follows the office") {
  SlamSettings settings = quick_settings();
  settings.keyframes.covisibility = CovisibilityKind::Vlad;
  settings.keyframes.window = 3;
  const Run first = run(9, settings);
  CHECK(evaluate_trajectory(first.trajectory, first.truth).ate.rmse < 0.02);
  for (const FrameReport& report : first.reports) CHECK_FALSE(report.lost());
  settings.keyframes.covisibility = CovisibilityKind::NetVlad;
  CHECK_THROWS_AS(Slam(settings, Intrinsics{}, engine_options()), InputError);
}

TEST_CASE("a frame that shows something else is reported as lost after re-tries, and the run goes on") {
  const SyntheticRecording recording = office(6);
  Slam slam(quick_settings(), recording.intrinsics(), engine_options());
  for (int i = 0; i < 3; ++i) slam.feed(*recording.load(i).frame);
  Frame covered = *recording.load(3).frame;
  covered.depth.setTo(0.3f);
  covered.colour.setTo(cv::Scalar(255, 0, 255));
  const FrameReport report = slam.feed(covered);
  CHECK(report.lost());
  CHECK(report.retries == 2);
  CHECK_FALSE(report.keyframe);
  CHECK(slam.trajectory().size() == 4);
  CHECK_FALSE(slam.feed(*recording.load(4).frame).lost());
}

TEST_CASE("a camera that was covered while it moved on is found again by its features") {
  const SyntheticRecording recording(device_options(), {.width = 240, .height = 180, .frames = 40});
  Slam slam(quick_settings(), recording.intrinsics(), engine_options());
  for (int i = 0; i < 4; ++i) slam.feed(*recording.load(i).frame);
  Frame covered = *recording.load(4).frame;
  covered.depth.setTo(0.3f);
  covered.colour.setTo(cv::Scalar(200, 150, 120));
  const FrameReport lost = slam.feed(covered);
  CHECK(lost.lost());
  // It has the last pose that was known, and claims no more.
  CHECK(lost.world_to_camera.matrix() == slam.reports()[3].world_to_camera.matrix());
  CHECK(slam.trajectory()[4].lost);
  CHECK_FALSE(slam.trajectory()[3].lost);

  const int away = 30;
  const Pose motion =
      recording.ground_truth()[away].camera_to_world.inverse() * recording.ground_truth()[3].camera_to_world;
  CHECK(motion.translation().norm() > 0.3);  // too far for an alignment from where it was
  const FrameReport found = slam.feed(*recording.load(away).frame);
  CHECK_FALSE(found.lost());
  CHECK(found.retries > 0);
  const Pose truth =
      recording.ground_truth()[away].camera_to_world.inverse() * recording.ground_truth()[0].camera_to_world;
  CHECK((found.world_to_camera * truth.inverse()).translation().norm() < 0.03);
  CHECK(position_sigma(found.covariance) > 0);
}

TEST_CASE("a camera that was carried back to where it was long ago is found there, in the whole map") {
  const SyntheticRecording recording(device_options(),
                                     {.path = "turn", .width = 200, .height = 150, .frames = 300});
  SlamSettings settings = quick_settings();
  settings.keyframes.interval = 1;
  Slam slam(settings, recording.intrinsics(), engine_options());
  // More keyframes than a frame's features are compared with before the whole map is asked.
  std::vector<int> fed;
  for (int i = 0; i < 96; i += 6) fed.push_back(i);
  for (int i : fed) REQUIRE(slam.feed(*recording.load(i).frame).state == TrackingState::Good);
  const int back = 3;
  const auto truth = [&](int i) {
    return recording.ground_truth()[i].camera_to_world.inverse() *
           recording.ground_truth()[0].camera_to_world;
  };
  const FrameReport found = slam.feed(*recording.load(back).frame);
  CHECK(found.state == TrackingState::Good);
  CHECK(found.found_at >= 0);
  CHECK(found.found_at < 3);
  CHECK((found.world_to_camera * truth(back).inverse()).translation().norm() < 0.02);
  // From there it goes on.
  const FrameReport next = slam.feed(*recording.load(back + 2).frame);
  CHECK(next.state == TrackingState::Good);
  CHECK(next.found_at == -1);
  CHECK((next.world_to_camera * truth(back + 2).inverse()).translation().norm() < 0.02);
  CHECK(slam.online_trajectory().size() == fed.size() + 2);
}

TEST_CASE("frames of the wrong size and a first frame without depth are refused and change nothing") {
  const SyntheticRecording recording = office(2);
  Slam slam(quick_settings(), recording.intrinsics(), engine_options());
  Frame blind = *recording.load(0).frame;
  blind.depth.setTo(0);
  CHECK_THROWS_AS(slam.feed(blind), InputError);
  Frame small = resize_frame(*recording.load(0).frame, 0.5);
  CHECK_THROWS_AS(slam.feed(small), UsageError);
  CHECK(slam.trajectory().empty());
  slam.feed(*recording.load(0).frame);
  CHECK(slam.trajectory().size() == 1);
}
