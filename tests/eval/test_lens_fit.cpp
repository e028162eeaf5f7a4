// Focal lengths without poses: on points of which everything is known, and on the real clips.
#include "engine/eval/lens_fit.h"

#include <cmath>
#include <random>

#include "engine/sources/open_dataset.h"
#include "tests/support/input_files.h"

using namespace surefield;

namespace {

constexpr Intrinsics kCamera{640, 480, 520, 500, 318, 245};

/// Pairs of frames of a camera that turns by up to `degrees` and moves a little, with errors as of a Kinect.
std::vector<MatchedFrames> made_pairs(double degrees) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> even(-1, 1);
  std::vector<MatchedFrames> pairs;
  for (int p = 0; p < 12; ++p) {
    MatchedFrames pair{p, p + 5, {}};
    const double radians = degrees * even(random) * 3.14159 / 180;
    const Eigen::Vector3d axis = Eigen::Vector3d(even(random), even(random), 0.5 * even(random)).normalized();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(radians, axis).toRotationMatrix();
    const Eigen::Vector3d shift = 0.1 * Eigen::Vector3d(even(random), even(random), even(random));
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector2d from(320 + 300 * even(random), 240 + 220 * even(random));
      const double depth = 2 + even(random);
      const Eigen::Vector3d x((from.x() - kCamera.cx) / kCamera.fx * depth,
                              (from.y() - kCamera.cy) / kCamera.fy * depth, depth);
      const Eigen::Vector3d y = turn * x + shift;
      const Eigen::Vector2d to(kCamera.fx * y.x() / y.z() + kCamera.cx,
                               kCamera.fy * y.y() / y.z() + kCamera.cy);
      PointMatch match{from, to, depth * (1 + 0.005 * noise(random)), y.z() * (1 + 0.005 * noise(random))};
      match.to += 0.4 * Eigen::Vector2d(noise(random), noise(random));
      if (i % 10 == 0) match.to += Eigen::Vector2d(40 * even(random), 40 * even(random));  // wrong matches
      pair.points.push_back(match);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

Intrinsics with(double focal, double aspect) {
  Intrinsics k = kCamera;
  k.fx *= focal * aspect;
  k.fy *= focal / aspect;
  return k;
}

}  // namespace

TEST_CASE("a camera that turns tells its focal lengths, with their errors") {
  const auto pairs = made_pairs(12);
  for (double focal : {1.0, 1.3, 0.7, 1.74}) {
    for (double aspect : {1.0, 1.12}) {
      CAPTURE(focal);
      CAPTURE(aspect);
      const LensFit fit = fit_lens(pairs, with(focal, aspect));
      CHECK(fit.pairs == 12);
      CHECK(std::abs(fit.focal.value + std::log(focal)) < std::max(0.005, 4 * fit.focal.error));
      CHECK(std::abs(fit.aspect.value + std::log(aspect)) < std::max(0.005, 4 * fit.aspect.error));
      CHECK(fit.focal.error < 0.02);
      CHECK(fit.aspect.error < 0.02);
      CHECK(fit.turn > 0.1);
    }
  }
}

TEST_CASE("the scale of depth does not matter") {
  auto pairs = made_pairs(12);
  const double before = fit_lens(pairs, kCamera).focal.value;
  for (MatchedFrames& pair : pairs) {
    for (PointMatch& match : pair.points) {
      match.from_depth *= 5;
      match.to_depth *= 5;
    }
  }
  CHECK(fit_lens(pairs, kCamera).focal.value == doctest::Approx(before).epsilon(0.001));
}

TEST_CASE("a camera that does not turn, or too few pairs: errors say that nothing is known") {
  CHECK(fit_lens(made_pairs(0), kCamera).focal.error > 0.1);
  CHECK(std::isinf(fit_lens({}, kCamera).focal.error));
}

TEST_CASE("[slow] the real clips tell their focal lengths without poses") {
  for (const char* name : {"tum_fr1_xyz", "replica_room0", "sevenscenes_redkitchen"}) {
    const auto folder = test::real_clip(name);
    if (folder.empty()) continue;
    CAPTURE(name);
    const Dataset dataset = open_dataset(folder);
    const auto pairs = match_frames(*dataset.recording);
    CHECK(pairs.size() >= 8);
    Intrinsics k = dataset.recording->intrinsics();
    CHECK(std::abs(fit_lens(pairs, k).focal.value) < 0.06);
    k.fx *= 1.3;
    k.fy *= 1.3;
    CHECK(std::abs(fit_lens(pairs, k).focal.value + std::log(1.3)) < 0.06);
  }
}
