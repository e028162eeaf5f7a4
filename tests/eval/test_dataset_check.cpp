// The check of calibrations: on plates of which everything is known, and on the real clips, altered.
#include "engine/eval/dataset_check.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "engine/eval/verdicts.h"
#include "engine/sources/layouts.h"
#include "tests/eval/planes.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::PlanesRecording;

namespace {

const Judgement& judged(const DatasetCheck& check, CheckedValue value) {
  const Judgement& judgement = check.judgements.at(static_cast<std::size_t>(value));
  CHECK(judgement.value == value);
  CHECK(judgement.judged);
  return judgement;
}

std::string findings_text(const DatasetCheck& check, const Recording& recording) {
  std::string text;
  for (const std::string& finding : findings_of(check_verdicts(check, recording))) text += finding + "\n";
  return text;
}

Verdict said(const DatasetCheck& check, const Recording& recording, const std::string& subject) {
  for (const Verdict& verdict : check_verdicts(check, recording))
    if (verdict.subject == subject) return verdict;
  FAIL("nothing is said about ", subject);
  return {};
}

/// Another dataset, changed in memory.
class Altered : public Recording {
 public:
  explicit Altered(const Dataset& original)
      : camera(original.recording->intrinsics()), original_(*original.recording) {
    if (original.ground_truth) truth = *original.ground_truth;
  }

  std::string name() const override { return original_.name(); }
  std::string format() const override { return original_.format(); }
  int count() const override { return original_.count() - depth_back; }
  Intrinsics intrinsics() const override { return camera; }
  double depth_unit() const override { return original_.depth_unit() * depth_factor; }
  double timestamp(int i) const override { return original_.timestamp(i + depth_back); }
  double depth_timestamp(int i) const override { return original_.depth_timestamp(i + depth_back); }
  Pose tracked_to_reference() const override { return original_.tracked_to_reference(); }

  LoadedFrame load(int i) const override {
    LoadedFrame loaded = original_.load(i + depth_back);
    if (!loaded.frame) return loaded;
    if (depth_back > 0) loaded.frame->depth = original_.load(i).frame->depth;
    loaded.frame->depth *= depth_factor;
    const cv::Size size(camera.width, camera.height);
    if (loaded.frame->colour.size() == size) return loaded;
    cv::resize(loaded.frame->colour.clone(), loaded.frame->colour, size, 0, 0, cv::INTER_LINEAR);
    cv::resize(loaded.frame->depth.clone(), loaded.frame->depth, size, 0, 0, cv::INTER_NEAREST);
    return loaded;
  }

  Intrinsics camera;
  Trajectory truth;
  double depth_factor = 1;
  int depth_back = 0;  ///< depth comes from so many frames before

 private:
  const Recording& original_;
};

/// Stretches the pixels to another shape, of which the intrinsics know, then swaps fx and fy.
Altered swapped(const Dataset& dataset) {
  Altered altered(dataset);
  Intrinsics& k = altered.camera;
  k.width = k.width * 5 / 4;
  k.fx *= 1.25;
  k.cx = 1.25 * (k.cx + 0.5) - 0.5;
  std::swap(k.fx, k.fy);
  return altered;
}

Dataset unregistered_kitchen(const std::filesystem::path& folder) {
  StoredSequence sequence = read_sevenscenes_sequence(folder);
  sequence.intrinsics = sequence.registration->depth;
  sequence.registration.reset();
  sequence.tracked_to_reference = Pose::Identity();
  return {std::make_unique<FileRecording>(sequence), sequence.ground_truth};
}

}  // namespace

TEST_CASE("plates as told: nothing is found wrong, and frames fit exactly") {
  const PlanesRecording planes(30);
  const DatasetCheck check = check_dataset(planes, planes.ground_truth());
  CHECK(check.has_poses);
  CHECK_FALSE(check.stamps_are_indices);
  CHECK(check.error.pairs >= 15);
  CHECK(check.error.depth_median < 0.002);
  CHECK(check.error.grey_levels < 3);
  CHECK(findings_text(check, planes).empty());
  CHECK(said(check, planes, "depth_scale").outcome == Outcome::Fits);
  CHECK(said(check, planes, "focal_length").outcome == Outcome::Fits);
  CHECK(said(check, planes, "registration").outcome == Outcome::Fits);
  CHECK(said(check, planes, "pose_delay").outcome == Outcome::Fits);
  CHECK(judged(check, CheckedValue::DepthScale).best == doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("plates with depth 1.25 times too large: the scale is found, nothing else") {
  PlanesRecording planes(30);
  planes.depth_factor = 1.25;
  const DatasetCheck check = check_dataset(planes, planes.ground_truth());
  const Judgement& scale = judged(check, CheckedValue::DepthScale);
  CHECK(scale.wrong);
  CHECK(scale.best == doctest::Approx(0.8).epsilon(0.02));
  CHECK(contains(findings_text(check, planes), "x too large: depth_unit is 1/1000 m, 1/12"));
  CHECK(findings_of(check_verdicts(check, planes)).size() == 1);
}

TEST_CASE(
    "[slow] plates with swapped focal lengths, shifted depth, or late stamps: each is found and measured") {
  PlanesRecording focal(30);
  focal.true_camera.fy = 140;
  focal.told = focal.true_camera;
  std::swap(focal.told.fx, focal.told.fy);
  CHECK(findings_text(check_dataset(focal, focal.ground_truth()), focal) ==
        "fx and fy look swapped: fx 110, fy 140 would fit\n");
  PlanesRecording shifted(30);
  shifted.depth_shift = 6;
  const DatasetCheck shift = check_dataset(shifted, shifted.ground_truth());
  CHECK(judged(shift, CheckedValue::DepthShiftX).wrong);
  CHECK(judged(shift, CheckedValue::DepthShiftX).best == doctest::Approx(-6).epsilon(0.1));
  CHECK(contains(findings_text(shift, shifted), "depth is not registered to colour"));
  PlanesRecording late(30);
  late.image_delay = 0.03;
  const DatasetCheck delay = check_dataset(late, late.ground_truth());
  CHECK(judged(delay, CheckedValue::PoseDelay).wrong);
  CHECK(judged(delay, CheckedValue::PoseDelay).best == doctest::Approx(0.03).epsilon(0.15));
  CHECK(contains(findings_text(delay, late), "the images look taken 3"));
  PlanesRecording depth_late(30);
  depth_late.depth_delay = 0.04;
  const DatasetCheck depth_delay = check_dataset(depth_late, depth_late.ground_truth());
  CHECK(judged(depth_delay, CheckedValue::DepthDelay).wrong);
  CHECK(judged(depth_delay, CheckedValue::DepthDelay).best == doctest::Approx(0.04).epsilon(0.15));
}

TEST_CASE("without poses: what takes them is not checked, and said so") {
  PlanesRecording planes(30);
  planes.with_truth = false;
  const DatasetCheck check = check_dataset(planes, planes.ground_truth());
  CHECK_FALSE(check.has_poses);
  CHECK(check.error.pairs == 0);
  CHECK(said(check, planes, "depth_scale").outcome == Outcome::NotChecked);
  CHECK(said(check, planes, "depth_scale").text == "it takes true poses");
  CHECK(said(check, planes, "pose_delay").outcome == Outcome::NotChecked);
  CHECK(said(check, planes, "registration").outcome == Outcome::Fits);
  CHECK(said(check, planes, "depth_delay").outcome == Outcome::Fits);
  CHECK(std::abs(judged(check, CheckedValue::DepthShiftX).best) <= 1);
  CHECK(findings_text(check, planes).empty());
}

TEST_CASE("poses of another clock are no poses") {
  const PlanesRecording planes(12);
  Trajectory truth = *planes.ground_truth();
  for (StampedPose& pose : truth) pose.timestamp += 1000;
  CHECK_FALSE(check_dataset(planes, &truth).has_poses);
}

TEST_CASE("plates with focal lengths 1.74 times too long: found") {
  PlanesRecording planes(30);
  planes.told.fx *= 1.74;
  planes.told.fy *= 1.74;
  CHECK(contains(findings_text(check_dataset(planes, planes.ground_truth()), planes), "x too long: fx 11"));
}

TEST_CASE("a camera that stands still: what it cannot reveal is not checked") {
  const PlanesRecording planes(30, false);
  const DatasetCheck check = check_dataset(planes, planes.ground_truth());
  for (const std::string subject :
       {"depth_scale", "focal_length", "focal_ratio", "depth_delay", "pose_delay"}) {
    CAPTURE(subject);
    CHECK_MESSAGE(said(check, planes, subject).outcome == Outcome::NotChecked,
                  said(check, planes, subject).text);
  }
}

TEST_CASE("check_dataset tells how far it is, and stops when told to") {
  const PlanesRecording planes(12);
  std::vector<double> steps;
  check_dataset(planes, planes.ground_truth(), [&](double done) { return steps.push_back(done), true; });
  CHECK(std::is_sorted(steps.begin(), steps.end()));
  CHECK(steps.back() <= 1);
  CHECK(steps.size() > 8);
  int asked = 0;
  const DatasetCheck check =
      check_dataset(planes, planes.ground_truth(), [&](double) { return ++asked < 3; });
  CHECK(asked < 10);
  CHECK(check.judgements.size() == 8);
}

TEST_CASE("[slow] the real clips as they are: nothing is found wrong") {
  for (const char* name : {"tum_fr1_xyz", "replica_room0", "sevenscenes_redkitchen"}) {
    const auto folder = test::real_clip(name);
    if (folder.empty()) continue;
    CAPTURE(name);
    const auto dataset = open_dataset(folder);
    const DatasetCheck check = check_dataset(*dataset.recording, dataset.truth());
    CHECK(check.error.pairs >= 15);
    CHECK(findings_text(check, *dataset.recording).empty());
  }
}

TEST_CASE("[slow] fr1_xyz altered: depth scale, stamps of the poses, depth of an earlier frame") {
  const auto folder = test::real_clip("tum_fr1_xyz");
  if (folder.empty()) return;
  const auto dataset = open_dataset(folder);
  Altered scaled(dataset);
  scaled.depth_factor = 1.25;
  const DatasetCheck scale = check_dataset(scaled, &scaled.truth);
  CHECK(judged(scale, CheckedValue::DepthScale).wrong);
  CHECK(judged(scale, CheckedValue::DepthScale).best == doctest::Approx(0.8).epsilon(0.04));
  CHECK(contains(findings_text(scale, scaled), "do the files use 1/5000 m?"));
  for (double delay : {0.03, -0.03}) {
    Altered late(dataset);
    for (StampedPose& pose : late.truth) pose.timestamp += delay;
    const DatasetCheck check = check_dataset(late, &late.truth);
    CHECK(judged(check, CheckedValue::PoseDelay).wrong);
    CHECK(std::abs(judged(check, CheckedValue::PoseDelay).best - delay) < 0.008);
  }
  Altered old_depth(dataset);
  old_depth.depth_back = 1;
  const DatasetCheck depth = check_dataset(old_depth, &old_depth.truth);
  CHECK(judged(depth, CheckedValue::DepthDelay).wrong);
  CHECK(judged(depth, CheckedValue::DepthDelay).best < -0.03);
}

TEST_CASE("[slow] clips stretched to other pixels, with fx and fy swapped: the swap is named") {
  for (const char* name : {"tum_fr1_xyz", "replica_room0"}) {
    const auto folder = test::real_clip(name);
    if (folder.empty()) continue;
    CAPTURE(name);
    const auto dataset = open_dataset(folder);
    const Altered altered = swapped(dataset);
    CHECK(contains(findings_text(check_dataset(altered, &altered.truth), altered), "fx and fy look swapped"));
  }
}

TEST_CASE("[slow] RedKitchen read without registration: depth is not registered") {
  const auto folder = test::real_clip("sevenscenes_redkitchen");
  if (folder.empty()) return;
  const auto raw = unregistered_kitchen(folder);
  const DatasetCheck before = check_dataset(*raw.recording, raw.truth());
  CHECK(contains(findings_text(before, *raw.recording), "depth is not registered to colour"));
  const auto registered = open_dataset(folder);
  CHECK(check_dataset(*registered.recording, registered.truth()).error.grey_levels <
        0.8 * before.error.grey_levels);
}
