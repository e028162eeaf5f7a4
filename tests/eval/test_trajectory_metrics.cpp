#include "engine/eval/trajectory_metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "engine/types/error.h"

using namespace surefield;

namespace {

StampedPose at(double timestamp, const Eigen::Vector3d& position) {
  StampedPose pose;
  pose.timestamp = timestamp;
  pose.camera_to_world.translation() = position;
  return pose;
}

/// A curve through space with turning cameras.
Trajectory make_curve(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double s = 0.1 * i;
    StampedPose pose = at(i, {std::cos(s), std::sin(2 * s), 0.3 * s});
    pose.camera_to_world.linear() =
        Eigen::AngleAxisd(s, Eigen::Vector3d(1, 1, 0.5).normalized()).toRotationMatrix();
    trajectory.push_back(pose);
  }
  return trajectory;
}

Eigen::Isometry3d some_motion() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(2.1, Eigen::Vector3d(-1, 3, 2).normalized()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(5, -6, 7);
  return motion;
}

Trajectory moved(Trajectory trajectory, const Eigen::Isometry3d& motion) {
  for (StampedPose& pose : trajectory) pose.camera_to_world = motion * pose.camera_to_world;
  return trajectory;
}

StampedPose unknown(double timestamp) {
  StampedPose pose = at(timestamp, Eigen::Vector3d::Zero());
  pose.camera_to_world.matrix().setConstant(-std::numeric_limits<double>::infinity());
  return pose;
}

}  // namespace

TEST_CASE("the same curve in another world has no error, and the alignment is found") {
  const Trajectory truth = make_curve(50);
  const TrajectoryMetrics metrics = evaluate_trajectory(moved(truth, some_motion()), truth);
  CHECK(metrics.pairs == 50);
  CHECK(metrics.estimates == 50);
  CHECK(metrics.ate.rmse < 1e-12);
  CHECK(metrics.ate.max < 1e-12);
  CHECK(metrics.rpe_frame.translation < 1e-12);
  CHECK(metrics.rpe_frame.rotation < 1e-6);
  CHECK(metrics.alignment.isApprox(some_motion().inverse(), 1e-9));
}

TEST_CASE("errors do not depend on the worlds of either trajectory") {
  const Trajectory truth = make_curve(40);
  Trajectory estimate = truth;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.05);
  for (StampedPose& pose : estimate) {
    pose.camera_to_world.translation() += Eigen::Vector3d(noise(random), noise(random), noise(random));
  }
  const TrajectoryMetrics a = evaluate_trajectory(estimate, truth);
  const TrajectoryMetrics b = evaluate_trajectory(moved(estimate, some_motion()), truth);
  CHECK(a.ate.rmse > 0.05);
  CHECK(a.ate.rmse == doctest::Approx(b.ate.rmse).epsilon(1e-9));
  CHECK(a.ate.median == doctest::Approx(b.ate.median).epsilon(1e-9));
  CHECK(a.rpe_frame.translation == doctest::Approx(b.rpe_frame.translation).epsilon(1e-9));
}

TEST_CASE("a scaled square shows its error: scale is not aligned") {
  // Corners of a square of half side 1 and of half side 1.1: each is off by 0.1 sqrt(2) after alignment.
  Trajectory truth;
  Trajectory estimate;
  const std::vector<Eigen::Vector3d> corners = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    truth.push_back(at(static_cast<double>(i), corners[i]));
    estimate.push_back(at(static_cast<double>(i), 1.1 * corners[i] + Eigen::Vector3d(3, 2, 1)));
  }
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth);
  const double expected = 0.1 * std::numbers::sqrt2;
  CHECK(metrics.ate.rmse == doctest::Approx(expected));
  CHECK(metrics.ate.mean == doctest::Approx(expected));
  CHECK(metrics.ate.median == doctest::Approx(expected));
  CHECK(metrics.ate.max == doctest::Approx(expected));
  CHECK(metrics.rpe_frame.translation == doctest::Approx(0.2));  // each side is 2.2 instead of 2
  CHECK(metrics.rpe_frame.rotation == doctest::Approx(0));
}

TEST_CASE("one outlier: mean, median, RMSE and largest error of four points on a line") {
  // The estimate is off by 0, 0, 0, 4 along z for four points on the x and y axes, symmetric so that only the
  // translation adapts; the numbers follow from z' = z + a x + b y + c with small angles, checked here by the
  // optimum.
  const std::vector<Eigen::Vector3d> points = {{100, 0, 0}, {-100, 0, 0}, {0, 100, 0}, {0, -100, 0}};
  Trajectory truth;
  Trajectory estimate;
  for (std::size_t i = 0; i < points.size(); ++i) {
    truth.push_back(at(static_cast<double>(i), points[i]));
    estimate.push_back(at(static_cast<double>(i), points[i] + Eigen::Vector3d(0, 0, i == 3 ? 0.04 : 0)));
  }
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth);
  // Least squares plane through (0, 0, 0, 0.04): residuals 0.01 (+ + - -).
  CHECK(metrics.ate.rmse == doctest::Approx(0.01).epsilon(1e-3));
  CHECK(metrics.ate.max == doctest::Approx(0.01).epsilon(1e-3));
  // An outlier in time order, far off: the steps into it and out of it carry the relative error.
  Trajectory spiked = make_curve(101);
  const Trajectory curve = spiked;
  spiked[50].camera_to_world.translation() += Eigen::Vector3d(0, 0, 1);
  const TrajectoryMetrics spike = evaluate_trajectory(spiked, curve);
  CHECK(spike.ate.max > 0.9);
  CHECK(spike.ate.median < 0.05);
  CHECK(spike.rpe_frame.translation == doctest::Approx(std::sqrt(2.0 / 100)).epsilon(1e-6));
}

TEST_CASE("RPE of a constant turn") {
  // The truth stands still in rotation; the estimate turns by 0.1 rad a frame about the camera's own centre.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 10; ++i) {
    truth.push_back(at(i, {0.5 * i, 0.1 * i * i, 0}));
    estimate.push_back(truth.back());
    estimate.back().camera_to_world.linear() =
        Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitX()).toRotationMatrix();
  }
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth);
  CHECK(metrics.rpe_frame.rotation == doctest::Approx(0.1));
  CHECK(metrics.ate.rmse < 1e-9);
}

TEST_CASE("association: nearest first, each pose once, nothing beyond 0.02 s, unknown poses skipped") {
  const Trajectory truth = {at(0.000, {1, 0, 0}), at(0.100, {2, 0, 0}), unknown(0.200), at(0.300, {4, 0, 0})};
  Trajectory estimate = {unknown(0.1)};
  for (double timestamp : {0.301, 0.004, -0.001, 0.121, 0.2}) {
    estimate.push_back(at(timestamp, Eigen::Vector3d::Zero()));
  }
  const std::vector<PosePair> pairs = associate(estimate, truth);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].timestamp == -0.001);  // nearer to 0 than 0.004, which finds no other
  CHECK(pairs[0].truth.translation().x() == 1);
  CHECK(pairs[1].timestamp == 0.301);
  CHECK(associate(estimate, truth, 0.022).size() == 3);
  CHECK(associate({}, truth).empty());
  CHECK(associate(estimate, {}).empty());
}

TEST_CASE("fewer than three pairs are refused with the count; three are enough") {
  const Trajectory truth = make_curve(10);
  const Trajectory two(truth.begin(), truth.begin() + 2);
  CHECK_THROWS_WITH_AS(evaluate_trajectory(two, truth), doctest::Contains("only 2 poses can be paired"),
                       InputError);
  CHECK_THROWS_AS(evaluate_trajectory({}, truth), InputError);
  const Trajectory three(truth.begin(), truth.begin() + 3);
  CHECK(evaluate_trajectory(three, truth).ate.rmse < 1e-12);
}

TEST_CASE("degenerate trajectories give finite errors: standing still, and a straight line") {
  Trajectory still;
  Trajectory line;
  for (int i = 0; i < 5; ++i) {
    still.push_back(at(i, {1, 2, 3}));
    line.push_back(at(i, {0.1 * i, 0, 0}));
  }
  CHECK(evaluate_trajectory(still, still).ate.rmse < 1e-12);
  CHECK(evaluate_trajectory(moved(line, some_motion()), line).ate.rmse < 1e-12);
  // Standing still where the truth covers 0 to 0.4 m: off by the distance from the middle, 0.2 0.1 0 0.1 0.2.
  const TrajectoryMetrics metrics = evaluate_trajectory(still, line);
  CHECK(metrics.ate.rmse == doctest::Approx(std::sqrt(0.02)));
  CHECK(metrics.ate.mean == doctest::Approx(0.12));
  CHECK(metrics.ate.median == doctest::Approx(0.1));
  CHECK(metrics.ate.max == doctest::Approx(0.2));
}

TEST_CASE("RPE over a second pairs each pose with the one a second later, and skips gaps") {
  // At 10 Hz along x, the estimate 1 % too long: 0.1 m a second at 10 m/s, a tenth of it from frame to frame.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 31; ++i) {
    const double jitter = i % 2 == 0 ? 0.004 : -0.004;
    truth.push_back(at(0.1 * i + jitter, {1.0 * i, std::sin(i), 0}));
    estimate.push_back(at(0.1 * i + jitter, {1.01 * i, std::sin(i), 0}));
  }
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth);
  CHECK(metrics.rpe_frame.motions == 30);
  CHECK(metrics.rpe_frame.translation == doctest::Approx(0.01));
  CHECK(metrics.rpe_second.motions == 21);
  CHECK(metrics.rpe_second.translation == doctest::Approx(0.1));
  // Without frames 10 to 21 no two of those left lie 0.9 to 1.1 s apart.
  estimate.erase(estimate.begin() + 10, estimate.begin() + 22);
  const TrajectoryMetrics gap = evaluate_trajectory(estimate, truth);
  CHECK(gap.rpe_frame.motions == 18);
  CHECK(gap.rpe_second.motions == 0);
  CHECK(gap.rpe_second.translation == 0);
}

TEST_CASE("RPE over a second of a turn adds the turns of its frames") {
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 61; ++i) {
    truth.push_back(at(i / 30.0, {0.1 * i, 0.02 * i * i, 0}));
    estimate.push_back(truth.back());
    estimate.back().camera_to_world.linear() =
        Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitY()).toRotationMatrix();
  }
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth);
  CHECK(metrics.rpe_frame.rotation == doctest::Approx(0.01));
  CHECK(metrics.rpe_second.rotation == doctest::Approx(0.3));
  CHECK(metrics.rpe_second.motions == 31);
}

TEST_CASE("true poses that are unknown are skipped, by ATE and by both RPE") {
  Trajectory truth = make_curve(50);
  Trajectory estimate = truth;
  estimate[7].camera_to_world.translation() += Eigen::Vector3d(100, 0, 0);  // would spoil everything
  truth[7] = unknown(7);
  truth[20].camera_to_world.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth);
  CHECK(metrics.pairs == 48);
  CHECK(metrics.estimates == 50);
  CHECK(metrics.ate.max < 1e-9);
  CHECK(metrics.rpe_frame.translation < 1e-9);
  // The stamps are whole seconds here: 49 steps, less the two into and out of each gap.
  const RelativeError second = relative_error(associate(estimate, truth), 1.0);
  CHECK(second.motions == 45);
  CHECK(second.translation < 1e-9);
}

TEST_CASE("where stamps only count frames there is no error per second") {
  Trajectory truth = make_curve(10);
  CHECK(evaluate_trajectory(truth, truth).rpe_frame.motions == 9);
  CHECK(evaluate_trajectory(truth, truth).rpe_second.motions == 0);
  for (StampedPose& pose : truth) pose.timestamp += 0.25;
  CHECK(evaluate_trajectory(truth, truth).rpe_second.motions == 9);
}

TEST_CASE("a similarity finds the scale of an estimate, and no alignment takes it as it is") {
  const Trajectory truth = make_curve(50);
  Trajectory estimate = moved(truth, some_motion());
  for (StampedPose& pose : estimate) pose.camera_to_world.translation() *= 0.4;
  const TrajectoryMetrics similar =
      evaluate_trajectory(estimate, truth, {.alignment = Alignment::Similarity});
  CHECK(similar.scale == doctest::Approx(2.5).epsilon(1e-9));
  CHECK(similar.ate.max < 1e-9);
  CHECK(similar.rpe_frame.translation < 1e-9);
  CHECK(similar.alignment.isApprox(some_motion().inverse(), 1e-9));

  const TrajectoryMetrics rigid = evaluate_trajectory(estimate, truth);
  CHECK(rigid.scale == 1);
  CHECK(rigid.ate.rmse > 0.3);

  Trajectory beside = truth;
  for (StampedPose& pose : beside) pose.camera_to_world.translation() += Eigen::Vector3d(3, 0, 4);
  const TrajectoryMetrics plain = evaluate_trajectory(beside, truth, {.alignment = Alignment::None});
  CHECK(plain.ate.rmse == doctest::Approx(5));
  CHECK(plain.alignment.isApprox(Eigen::Isometry3d::Identity()));
}

TEST_CASE("a camera that stands still has no scale") {
  const Trajectory truth = make_curve(5);
  Trajectory still = truth;
  for (StampedPose& pose : still) pose.camera_to_world.translation() = Eigen::Vector3d(1, 2, 3);
  const TrajectoryComparison similar{.alignment = Alignment::Similarity};
  CHECK_THROWS_WITH_AS(evaluate_trajectory(still, truth, similar),
                       doctest::Contains("the estimated camera stands still"), InputError);
  CHECK_THROWS_WITH_AS(evaluate_trajectory(truth, still, similar),
                       doctest::Contains("the true camera stands still"), InputError);
}

TEST_CASE("poses that no stamps bring together are refused with how far apart the clocks are") {
  const Trajectory truth = make_curve(10);
  Trajectory estimate = truth;
  for (StampedPose& pose : estimate) pose.timestamp += 1000.5;
  CHECK_THROWS_WITH_AS(evaluate_trajectory(estimate, truth),
                       doctest::Contains("no pose of the truth is near one of the estimate (within 0.02 s): "
                                         "clocks differ by 1000.500 s; the estimate has stamps from 1000.500 "
                                         "to 1009.500, the truth from 0.000 to 9.000"),
                       InputError);
  for (StampedPose& pose : estimate) pose.timestamp -= 1000.2;
  CHECK_THROWS_WITH_AS(evaluate_trajectory(estimate, truth),
                       doctest::Contains("the nearest stamps are 0.300 s apart"), InputError);
  CHECK_THROWS_WITH_AS(evaluate_trajectory({unknown(1), unknown(2)}, truth),
                       doctest::Contains("the estimate has no pose that is known"), InputError);
  CHECK_THROWS_WITH_AS(evaluate_trajectory(estimate, {unknown(1)}),
                       doctest::Contains("the truth has no pose that is known"), InputError);
}

TEST_CASE("frames that were lost take no part in errors, and are counted") {
  const Trajectory truth = make_curve(50);
  Trajectory estimate = moved(truth, some_motion());
  for (int i : {7, 8, 30}) {
    estimate[i].lost = true;
    estimate[i].camera_to_world.translation().x() += 5;
  }
  const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth);
  CHECK(metrics.pairs == 47);
  CHECK(metrics.estimates == 50);
  CHECK(metrics.lost == 3);
  CHECK(metrics.ate.max < 1e-9);
}
