// Drift that is added on purpose: as much as was asked for, and what frames are aligned to does not undo it.
#include "engine/slam/simulated_drift.h"

#include <doctest/doctest.h>

#include <numbers>
#include <vector>

#include "tests/slam/office.h"

using namespace surefield;
using namespace surefield::testing;

namespace {

constexpr DriftSettings kTwist{.rotation = 0.05, .translation = 0.001};

/// How far two cameras are apart, and how far they are turned to each other.
struct Apart {
  double metres = 0, degrees = 0;
};

Apart apart(const Pose& world_to_camera, const Pose& other) {
  const Pose one = world_to_camera.inverse(), two = other.inverse();
  return {(one.translation() - two.translation()).norm(),
          Eigen::AngleAxisd(one.linear() * two.linear().transpose()).angle() * 180 / std::numbers::pi};
}

/// A camera that turns and walks on from keyframe to keyframe.
Pose motion(int k) {
  return Eigen::Translation3d(0.1, 0.02 * k, -0.2) * Eigen::AngleAxisd(0.3, Eigen::Vector3d(0, 0.8, 0.6)) *
         Pose::Identity();
}

}  // namespace

TEST_CASE("drift is proportional to the frames, whichever way the camera looks") {
  const SimulatedDrift drift(kTwist);
  CHECK_FALSE(drift.none());
  for (int k = 0; k < 4; ++k) {
    const Pose pose = motion(k) * motion(2);
    const Apart after = apart(drift.drifted(pose, 20), pose);
    CHECK(after.degrees == doctest::Approx(1));
    CHECK(after.metres == doctest::Approx(0.02));
    CHECK(apart(drift.drifted(drift.drifted(pose, 20), 30), drift.drifted(pose, 50)).metres < 1e-12);
    CHECK(apart(drift.drifted(drift.drifted(pose, 20), -20), pose).metres < 1e-12);
  }
  const DriftSettings nothing;
  CHECK(SimulatedDrift(nothing).none());
}

TEST_CASE("keyframes before the newest are seen where they truly are relative to it") {
  SimulatedDrift drift(kTwist);
  std::vector<Pose> drifted = {Pose::Identity()}, straight = drifted;
  drift.begin_keyframe(drifted[0], 0);
  for (int k = 1; k < 12; ++k) {
    straight.push_back(motion(k) * straight.back());
    drifted.push_back(drift.drifted(motion(k) * drifted.back(), 5 + k));
    drift.begin_keyframe(drifted.back(), 5 + k);
  }
  CHECK(drift.seen_from_newest(drifted[11], 0).matrix() == drifted[11].matrix());
  for (int older = 1; older <= 8; ++older) {
    CAPTURE(older);
    const Pose seen = drift.seen_from_newest(drifted[11 - older], older);
    const Apart relative = apart(drifted[11] * seen.inverse(), straight[11] * straight[11 - older].inverse());
    CHECK(relative.metres < 1e-12);
    CHECK(relative.degrees < 1e-5);
    CHECK(apart(drifted[11] * drifted[11 - older].inverse(), straight[11] * straight[11 - older].inverse())
              .metres > 1e-3);
  }
  // Those of an earlier visit stay where they are, and hold the camera.
  CHECK(drift.seen_from_newest(drifted[2], 9).matrix() == drifted[2].matrix());
}

TEST_CASE("a run with drift leaves the way by about as much as was asked for") {
  SlamSettings settings = quick_settings();
  Slam straight(settings, office_camera(), engine_options());
  settings.drift = {.rotation = 0.2, .translation = 0.004};
  Slam drifting(settings, office_camera(), engine_options());
  for (const Frame& frame : office_frames()) {
    straight.feed(frame);
    drifting.feed(frame);
  }
  const std::vector<FrameReport> one = straight.reports(), other = drifting.reports();
  for (std::size_t i = 0; i < one.size(); ++i) {
    CAPTURE(i);
    const Apart error = apart(other[i].world_to_camera, one[i].world_to_camera);
    const auto frames = static_cast<double>(i);
    CHECK(error.degrees >= 0.6 * 0.2 * frames);
    CHECK(error.degrees <= 1.2 * 0.2 * frames + 1e-5);
    CHECK(error.metres >= 0.5 * 0.004 * frames);
    CHECK(error.metres <= 1.5 * 0.004 * frames + 1e-12);
  }
}
