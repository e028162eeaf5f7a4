// What the real clips must parse to.
#include "engine/sources/open_dataset.h"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/input_files.h"

using namespace surefield;
using test::real_clip;

namespace {

/// Fraction of valid depths, and their range in metres.
struct DepthSummary {
  double valid = 0;
  double min = 0;
  double max = 0;
};

DepthSummary summarise(const cv::Mat& depth) {
  const cv::Mat valid = depth > 0;
  DepthSummary summary;
  summary.valid = static_cast<double>(cv::countNonZero(valid)) / static_cast<double>(depth.total());
  cv::minMaxLoc(depth, &summary.min, &summary.max, nullptr, nullptr, valid);
  return summary;
}

void check_intrinsics(const Intrinsics& actual, const Intrinsics& expected) {
  CHECK(actual.width == expected.width);
  CHECK(actual.height == expected.height);
  CHECK(actual.fx == expected.fx);
  CHECK(actual.fy == expected.fy);
  CHECK(actual.cx == expected.cx);
  CHECK(actual.cy == expected.cy);
}

Frame load(const Recording& recording, int i) {
  LoadedFrame loaded = recording.load(i);
  REQUIRE_MESSAGE(loaded.frame.has_value(), loaded.problem);
  CHECK(loaded.frame->index == i);
  CHECK(loaded.frame->timestamp == recording.timestamp(i));
  CHECK(loaded.frame->colour.type() == CV_8UC3);
  CHECK(loaded.frame->depth.type() == CV_32FC1);
  CHECK(loaded.frame->colour.size() == cv::Size(recording.intrinsics().width, recording.intrinsics().height));
  CHECK(loaded.frame->depth.size() == loaded.frame->colour.size());
  return *loaded.frame;
}

}  // namespace

TEST_CASE("TUM fr1_xyz: 150 pairs, Kinect depth, 901 true poses") {
  const auto folder = real_clip("tum_fr1_xyz");
  if (folder.empty()) return;
  const auto dataset = open_dataset(folder);
  CHECK(dataset.recording->format() == "tum");
  CHECK(dataset.recording->name() == "tum_fr1_xyz");
  CHECK(dataset.recording->count() == 150);
  CHECK(dataset.recording->warnings().empty());
  CHECK(dataset.recording->depth_unit() == 1.0 / 5000);
  check_intrinsics(dataset.recording->intrinsics(), {640, 480, 517.3, 516.5, 318.6, 255.3});
  CHECK(dataset.recording->timestamp(0) == 1305031102.175304);
  REQUIRE(dataset.ground_truth);
  CHECK(dataset.ground_truth->size() == 901);
  for (int i : {0, 75, 149}) {
    const DepthSummary depth = summarise(load(*dataset.recording, i).depth);
    CHECK(depth.valid > 0.5);
    CHECK(depth.min > 0.3);
    CHECK(depth.max < 10);
  }
}

TEST_CASE(
    "TUM images are undistorted: the colour differs from the stored one by the lens's displacement only") {
  const auto folder = real_clip("tum_fr1_xyz");
  if (folder.empty()) return;
  const auto dataset = open_dataset(folder);
  const Intrinsics k = dataset.recording->intrinsics();
  const Frame frame = load(*dataset.recording, 0);
  // The centre of the lens does not move.
  const cv::Mat stored = cv::imread((folder / "rgb/1305031102.175304.png").string());
  const auto bgr = stored.at<cv::Vec3b>(255, 319);
  const auto rgb = frame.colour.at<cv::Vec3b>(255, 319);
  for (int channel = 0; channel < 3; ++channel) CHECK(std::abs(rgb[channel] - bgr[2 - channel]) <= 12);
  // Half way to the right border the polynomial moves a point outwards by the amount computed here by hand.
  const double x = (480 - k.cx) / k.fx;
  const double r2 = x * x;
  const double radial = 1 + 0.2624 * r2 - 0.9531 * r2 * r2 + 1.1633 * r2 * r2 * r2;
  const double u = k.fx * (x * radial + 0.0026 * 3 * r2) + k.cx;
  const double v = k.fy * (-0.0054 * r2) + 255.3;
  cv::Mat patch;
  cv::getRectSubPix(stored, {1, 1}, {static_cast<float>(u), static_cast<float>(v)}, patch);
  const auto expected = patch.at<cv::Vec3b>(0, 0);
  const auto actual = frame.colour.at<cv::Vec3b>(255, 480);
  for (int channel = 0; channel < 3; ++channel)
    CHECK(std::abs(actual[channel] - expected[2 - channel]) <= 12);
}

TEST_CASE("Replica room0: 20 frames, perfect depth, stamps are frame indices") {
  const auto folder = real_clip("replica_room0");
  if (folder.empty()) return;
  const auto dataset = open_dataset(folder);
  CHECK(dataset.recording->format() == "replica");
  CHECK(dataset.recording->count() == 20);
  CHECK(dataset.recording->depth_unit() == 1 / 6553.5);
  check_intrinsics(dataset.recording->intrinsics(), {1200, 680, 600, 600, 599.5, 339.5});
  CHECK(dataset.recording->timestamp(7) == 7.0);
  REQUIRE(dataset.ground_truth);
  CHECK(dataset.ground_truth->size() >= 20);
  const StampedPose& first = dataset.ground_truth->front();
  CHECK(first.timestamp == 0);
  CHECK(first.camera_to_world.translation().x() == doctest::Approx(3.452987416406734678));
  CHECK(first.camera_to_world.linear()(1, 0) == doctest::Approx(0.94722495609).epsilon(1e-6));
  CHECK((first.camera_to_world.linear() * first.camera_to_world.linear().transpose()).isIdentity(1e-12));
  const DepthSummary depth = summarise(load(*dataset.recording, 19).depth);
  CHECK(depth.valid > 0.99);
  CHECK(depth.min > 0.3);
  CHECK(depth.max < 10.0);
}

TEST_CASE("7-Scenes RedKitchen: 300 frames and poses, 65535 is no depth") {
  const auto folder = real_clip("sevenscenes_redkitchen");
  if (folder.empty()) return;
  const auto dataset = open_dataset(folder);
  CHECK(dataset.recording->format() == "sevenscenes");
  CHECK(dataset.recording->count() == 300);
  CHECK(dataset.recording->depth_unit() == 0.001);
  check_intrinsics(dataset.recording->intrinsics(), {640, 480, 525, 525, 320, 240});
  REQUIRE(dataset.ground_truth);
  REQUIRE(dataset.ground_truth->size() == 300);
  CHECK(dataset.ground_truth->at(299).timestamp == 299);
  CHECK(dataset.ground_truth->front().camera_to_world.translation().z() ==
        doctest::Approx(0.2965691699999999));
  const DepthSummary depth = summarise(load(*dataset.recording, 150).depth);
  CHECK(depth.valid > 0.5);
  CHECK(depth.max < 20);
}

TEST_CASE("[slow] every frame of every clip loads") {
  for (const char* name : {"tum_fr1_xyz", "replica_room0", "sevenscenes_redkitchen"}) {
    const auto folder = real_clip(name);
    if (folder.empty()) continue;
    const auto dataset = open_dataset(folder);
    for (int i = 0; i < dataset.recording->count(); ++i) {
      const LoadedFrame loaded = dataset.recording->load(i);
      CHECK_MESSAGE(loaded.frame.has_value(), loaded.problem);
    }
  }
}
