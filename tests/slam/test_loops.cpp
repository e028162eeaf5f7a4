// Loops: keyframes with the images of a synthetic office and poses that have drifted, without mapping.
#include <doctest/doctest.h>

#include <map>

#include "engine/slam/loop_closer.h"
#include "tests/slam/office.h"

using namespace surefield;
using testing::engine_options;

namespace {

constexpr int kStep = 6;  // frames between keyframes

/// The office, seen by a camera that turns round in it once and a bit more.
const SyntheticRecording& turn() {
  static const SyntheticRecording recording(testing::device_options(),
                                            {.path = "turn", .width = 160, .height = 120, .frames = 300});
  return recording;
}

/// A frame of it, rendered once.
const Frame& turn_frame(int i) {
  static std::map<int, Frame> frames;
  const auto found = frames.find(i);
  return found != frames.end() ? found->second : frames.emplace(i, *turn().load(i).frame).first->second;
}

/// By so much, in the world, a camera that should stand still has moved after so many keyframes.
Pose drift_after(int keyframes) {
  Pose drift = Pose::Identity();
  drift.linear() = Eigen::AngleAxisd(0.003 * keyframes, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
  drift.translation() = 0.004 * keyframes * Eigen::Vector3d(2, 1, -2) / 3;
  return drift;
}

/// Keyframes, a Gaussian in the middle of what each sees, and what closes loops over them.
struct Walk {
  SlamSettings settings;
  SplatEngine engine{engine_options()};
  KeyframeGraph keyframes{settings.keyframes, nullptr};
  LoopCloser closer;

  Walk() : closer(engine, settings, turn().intrinsics(), keyframes) { engine.assign({}); }

  /// Adds the keyframe of a frame where it is thought to be; returns what it has come back to.
  std::optional<int> add(int frame_index, const Pose& world_to_camera) {
    const Frame& frame = turn_frame(frame_index);
    const FrameHandle handle = engine.load(
        {frame.colour.cols, frame.colour.rows, frame.colour.ptr<uint8_t>(), frame.depth.ptr<float>()});
    Keyframe keyframe = make_keyframe(frame, handle, {turn().intrinsics(), world_to_camera},
                                      sample_points(frame, turn().intrinsics()));
    keyframe.grid = make_colour_grid(frame);
    keyframe.features = place_features(frame, turn().intrinsics());
    GaussianCloud birth;
    birth.resize(1);
    birth.means[0] = (world_to_camera.inverse() * keyframe.middle).cast<float>();
    birth.anchors[0] = static_cast<uint32_t>(keyframes.newest() + 1);
    engine.insert(birth);
    keyframes.add(std::move(keyframe), {});
    const int newest = keyframes.newest();
    keyframes.set_window({std::max(0, newest - 1), newest}, 4);
    if (newest > 0) return closer.close(newest - 1, PoseCovariance::Zero());
    closer.begin();
    return std::nullopt;
  }

  Pose true_pose(int frame) const {
    return turn().ground_truth()[frame].camera_to_world.inverse() * turn().ground_truth()[0].camera_to_world;
  }

  /// How far the keyframe is from the truth, metres.
  double error(int k, int frame) const {
    return (keyframes.world_to_camera(k) * true_pose(frame).inverse()).translation().norm();
  }
};

/// A turn with drift; poses follow those of the keyframe before, corrected or not.
void walk_round(Walk& walk, std::vector<std::optional<int>>* back = nullptr) {
  for (int k = 0; k * kStep < turn().count(); ++k) {
    Pose pose = walk.true_pose(k * kStep);
    if (k > 0) {
      const Pose step = pose * walk.true_pose((k - 1) * kStep).inverse();
      const Pose slip = drift_after(k - 1) * drift_after(k).inverse();
      pose = step * walk.keyframes.world_to_camera(k - 1) * slip;
    }
    const auto found = walk.add(k * kStep, pose);
    if (back) back->push_back(found);
  }
}

}  // namespace

TEST_CASE("a camera that comes back finds its place, and keyframes and Gaussians follow") {
  Walk walk;
  std::vector<std::optional<int>> back;
  walk_round(walk, &back);
  const int closed_at = static_cast<int>(
      std::find_if(back.begin(), back.end(), [](const auto& k) { return k.has_value(); }) - back.begin());
  REQUIRE(closed_at < static_cast<int>(back.size()));
  int accepted = 0;
  for (const Loop& loop : walk.closer.loops()) {
    if (!loop.counts()) continue;
    ++accepted;
    // Its motion is the true one.
    const int from = loop.measured.from * kStep, to = loop.measured.to * kStep;
    const Pose truth = walk.true_pose(to) * walk.true_pose(from).inverse();
    const Pose off = loop.measured.pose * truth.inverse();
    CHECK(off.translation().norm() < 0.02);
    CHECK(Eigen::AngleAxisd(off.rotation()).angle() < 0.01);
    CHECK(loop.measured.to - loop.measured.from >= 10);
  }
  CHECK(accepted >= 2);
  CHECK(walk.closer.odometry().size() == back.size() - 1);
  const double drifted = drift_after(closed_at).translation().norm();
  CHECK(drifted > 0.1);
  CHECK(walk.error(closed_at, closed_at * kStep) < 0.3 * drifted);
  // The Gaussian of a keyframe is where that sees it.
  const GaussianCloud map = walk.engine.map();
  for (int k = 0; k <= walk.keyframes.newest(); ++k) {
    const Keyframe& keyframe = walk.keyframes[k];
    const Eigen::Vector3d seen = keyframe.camera.world_to_camera * map.means[k].cast<double>();
    CHECK((seen - keyframe.middle).norm() < 1e-3);
  }
}

TEST_CASE("the same keyframes close the same loop, bit by bit") {
  Walk one, other;
  walk_round(one);
  walk_round(other);
  REQUIRE(one.closer.loops().size() == other.closer.loops().size());
  for (int k = 0; k <= one.keyframes.newest(); ++k)
    CHECK(one.keyframes.world_to_camera(k).matrix() == other.keyframes.world_to_camera(k).matrix());
  CHECK(one.engine.map().means == other.engine.map().means);
}

TEST_CASE("another room that looks the same is farther away than a camera drifts: no loop") {
  Walk walk;
  const auto look_round = [&](double x) {
    for (int frame = 0; frame < 90; frame += kStep)
      CHECK_FALSE(walk.add(frame, walk.true_pose(frame) * Eigen::Translation3d(x, 0, 0)));
  };
  look_round(0);
  look_round(-6);
  int too_far = 0;
  for (const Loop& loop : walk.closer.loops()) {
    CHECK_FALSE(loop.counts());
    too_far += loop.verdict == LoopVerdict::TooFar;
  }
  CHECK(too_far > 0);
}

TEST_CASE("poses that are right stay as they are when a place is seen again") {
  Walk walk;
  for (int frame = 0; frame < turn().count(); frame += kStep)
    CHECK_FALSE(walk.add(frame, walk.true_pose(frame)));
  int agreed = 0;
  for (const Loop& loop : walk.closer.loops()) agreed += loop.verdict == LoopVerdict::Agreed;
  CHECK(agreed > 0);
  for (int k = 0; k <= walk.keyframes.newest(); ++k)
    CHECK(walk.keyframes.world_to_camera(k).matrix() == walk.true_pose(k * kStep).matrix());
}

TEST_CASE("a false loop is taken back, and poses and map are what they were") {
  Walk walk;
  for (int frame = 0; frame < turn().count(); frame += kStep) walk.add(frame, walk.true_pose(frame));
  const GaussianCloud before = walk.engine.map();
  // Half a turn away, by what two keyframes in a row say: the camera would be where it was at first.
  const int newest = walk.keyframes.newest();
  const auto false_loop = [&](int to) {
    Loop loop{.measured = {.from = 20,
                           .to = to,
                           .pose = Pose::Identity(),
                           .information = 1e4 * Matrix6::Identity()},
              .verdict = LoopVerdict::Waiting};
    loop.measured.pose =
        walk.keyframes.world_to_camera(to) * walk.keyframes.world_to_camera(newest).inverse();
    return loop;
  };
  CHECK_FALSE(walk.closer.follow({false_loop(newest - 1)}));
  CHECK_FALSE(walk.closer.follow({false_loop(newest)}));
  const std::vector<Loop>& loops = walk.closer.loops();
  CHECK(loops[loops.size() - 1].verdict == LoopVerdict::Contradicted);
  CHECK(loops[loops.size() - 2].verdict == LoopVerdict::Contradicted);
  for (int k = 0; k <= newest; ++k)
    CHECK(walk.keyframes.world_to_camera(k).matrix() == walk.true_pose(k * kStep).matrix());
  CHECK(walk.engine.map().means == before.means);
}
