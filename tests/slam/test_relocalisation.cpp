// Finding single frames in a map, without knowing anything of where the camera was before.
#include <doctest/doctest.h>

#include <functional>

#include "engine/eval/place_metrics.h"
#include "engine/sources/frame_stream.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
#include "tests/slam/office.h"
#include "tests/support/input_files.h"

using namespace surefield;

namespace {

constexpr double kNear = 0.05, kTurned = 5 * 0.0174533;  // metres, radians: a frame is found within these
constexpr double kShared = 0.3;                          // of what a frame and a keyframe see

/// A sequence of which the first part is mapped, at the size at which SLAM sees it.
struct Walk {
  Intrinsics intrinsics;
  Trajectory truth;
  std::function<Frame(int)> frame;
  int mapped = 0;  ///< frames
};

bool is_at(const Pose& pose, const Pose& truth) {
  const Pose off = pose * truth.inverse();
  return off.translation().norm() < kNear && Eigen::AngleAxisd(off.rotation()).angle() < kTurned;
}

/// How frames behind the mapped part were found.
struct Found {
  int there = 0, right = 0, wrong = 0;
};

PlaceView view_of(const Walk& walk, int i) {
  return {{walk.intrinsics, Pose(walk.truth[i].camera_to_world.inverse())}, walk.frame(i).depth};
}

/// What a keyframe saw, and where the map has it.
struct MappedView {
  PlaceView truth;
  Pose estimate;

  /// How much both see of the other.
  double shared(const PlaceView& view) const {
    return std::min(shared_view(view, truth), shared_view(truth, view));
  }
};

/// Maps the first part, then looks for every `step`th frame of the rest. Those count as there that share
/// enough with a keyframe, at the true poses; each is compared with the truth in the world of the keyframe
/// that it shares most with, so that what counts is where it is in the map.
Found look_for_rest(const Walk& walk, const SlamSettings& settings, int step) {
  Slam slam(settings, walk.intrinsics, {.device = testing::device_options().selector});
  for (int i = 0; i < walk.mapped; ++i) slam.feed(walk.frame(i));
  slam.finish();
  std::vector<MappedView> keyframes;
  const std::vector<FrameReport> reports = slam.reports();
  const Trajectory trajectory = slam.trajectory();
  for (std::size_t i = 0; i < reports.size(); ++i)
    if (reports[i].keyframe)
      keyframes.push_back({view_of(walk, reports[i].index), Pose(trajectory[i].camera_to_world.inverse())});
  Found found;
  for (int i = walk.mapped; i < static_cast<int>(walk.truth.size()); i += step) {
    const PlaceView view = view_of(walk, i);
    const auto best = std::max_element(keyframes.begin(), keyframes.end(), [&](const auto& a, const auto& b) {
      return a.shared(view) < b.shared(view);
    });
    const bool there = best->shared(view) >= kShared;
    const FrameReport report = slam.locate(walk.frame(i));
    const Pose from_keyframe = report.world_to_camera * best->estimate.inverse();
    const bool right =
        is_at(from_keyframe, view.camera.world_to_camera * best->truth.camera.world_to_camera.inverse());
    found.there += there;
    found.right += there && right && !report.lost();
    found.wrong += report.state == TrackingState::Good && !right;
  }
  return found;
}

void check(const Found& found, const std::string& name, double least_share, int most_wrong) {
  MESSAGE(name, ": ", found.right, " of ", found.there, " frames found, ", found.wrong, " at a wrong place");
  CHECK(found.there > 10);
  CHECK(found.right >= least_share * found.there);
  CHECK(found.wrong <= most_wrong);
}

Walk synthetic(const std::string& scene, const std::string& path, int frames) {
  const auto recording = std::make_shared<SyntheticRecording>(testing::device_options(),
                                                              SynthSettings{.scene = scene,
                                                                            .path = path,
                                                                            .width = 160,
                                                                            .height = 120,
                                                                            .frames = frames,
                                                                            .seed = 3,
                                                                            .sensor = SensorKind::Kinect});
  return {recording->intrinsics(), recording->ground_truth(),
          [=](int i) { return *recording->load(i).frame; }, 2 * frames / 5};
}

}  // namespace

TEST_CASE("a frame is found in the map by itself, one of another place is not, and nothing changes") {
  const SyntheticRecording turn(testing::device_options(),
                                {.path = "turn", .width = 160, .height = 120, .frames = 300});
  const auto frame = [&](int i) { return *turn.load(i).frame; };
  SlamSettings settings = testing::quick_settings();
  Slam slam(settings, turn.intrinsics(), testing::engine_options());
  CHECK_THROWS_AS(slam.locate(frame(0)), StateError);
  for (int i = 0; i < 40; i += 2) slam.feed(frame(i));
  const GaussianCloud map = slam.map();
  const Trajectory trajectory = slam.trajectory();
  for (int i : {5, 21, 33}) {
    CAPTURE(i);
    const FrameReport report = slam.locate(frame(i));
    CHECK(report.state == TrackingState::Good);
    CHECK(report.index == i);
    const Pose truth(turn.ground_truth()[i].camera_to_world.inverse() *
                     turn.ground_truth()[0].camera_to_world);
    CHECK(is_at(report.world_to_camera, truth));
  }
  CHECK(slam.locate(frame(150)).lost());
  CHECK(slam.map().means == map.means);
  CHECK(slam.map().opacity_logits == map.opacity_logits);
  CHECK(slam.trajectory().size() == trajectory.size());
  CHECK(slam.trajectory().back().camera_to_world.matrix() == trajectory.back().camera_to_world.matrix());
  CHECK(slam.feed(frame(40)).state == TrackingState::Good);
  slam.finish();
  CHECK(slam.locate(frame(21)).state == TrackingState::Good);
}

TEST_CASE("[long] frames behind the mapped part of a clip are found, hardly one at a wrong place") {
  const auto folder = test::real_clip("sevenscenes_redkitchen");
  if (folder.empty()) return;
  const Dataset dataset = open_dataset(folder);
  const Recording& recording = *dataset.recording;
  const auto frame = [&](int i) { return resize_frame(*recording.load(i).frame, 0.5); };
  Trajectory truth = *dataset.ground_truth;
  for (StampedPose& pose : truth)
    pose.camera_to_world = pose.camera_to_world * recording.tracked_to_reference();
  check(look_for_rest({recording.intrinsics().scaled(0.5), truth, frame, 2 * recording.count() / 5}, {}, 4),
        "RedKitchen", 0.85, 1);
}

TEST_CASE("[long] frames behind the mapped part of synthetic rooms are found, none at a wrong place") {
  check(look_for_rest(synthetic("office", "handheld", 300), {}, 4), "office", 0.9, 0);
  check(look_for_rest(synthetic("hall", "handheld", 300), {}, 4), "hall", 0.6, 0);
}
