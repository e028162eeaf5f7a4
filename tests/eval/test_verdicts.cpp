// What is said of files, frames, stamps, intrinsics, depth and poses.
#include "engine/eval/verdicts.h"

#include "tests/sources/fake_recording.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;

namespace {

class Told : public test::FakeRecording {
 public:
  using FakeRecording::FakeRecording;
  Intrinsics intrinsics() const override { return camera; }
  int left_out() const override { return without_depth; }
  Intrinsics camera = {8, 6, 10, 10, 3.5, 2.5};
  int without_depth = 0;
};

DatasetSurvey good_survey() {
  DatasetSurvey survey;
  survey.frames = 20;
  survey.stamps = {.indices = false, .duration = 1, .spacing = 0.05};
  survey.depth = DepthRange{0.6, 1.8, 4, 0.1, 0};
  return survey;
}

Verdict said(const Recording& recording, const Trajectory* truth, const DatasetSurvey& survey,
             const std::string& subject) {
  for (const Verdict& verdict : survey_verdicts(recording, truth, survey, {5, 15}))
    if (verdict.subject == subject) return verdict;
  FAIL("nothing is said about ", subject);
  return {};
}

void check_faulty(const Verdict& verdict, const std::string& text) {
  CHECK(verdict.outcome == Outcome::DoesNotFit);
  CHECK_MESSAGE(contains(verdict.text, text), verdict.text);
}

}  // namespace

TEST_CASE("a good survey: all fits but for what there is not") {
  const Told told(20);
  for (const Verdict& verdict : survey_verdicts(told, nullptr, good_survey(), {5, 15})) {
    CAPTURE(verdict.subject);
    CHECK_FALSE(verdict.text.empty());
    CHECK(verdict.outcome == (verdict.subject == "poses" ? Outcome::NotChecked : Outcome::Fits));
  }
  CHECK(findings_of(survey_verdicts(told, nullptr, good_survey(), {5, 15})).empty());
}

TEST_CASE("unreadable frames: a few are told, more do not fit, and of none nothing else is said") {
  const Told told(20);
  DatasetSurvey survey = good_survey();
  survey.unreadable = {{3, "depth/3.png: is no image"}};
  CHECK(said(told, nullptr, survey, "files").outcome == Outcome::Fits);
  CHECK(contains(said(told, nullptr, survey, "files").text,
                 "1 of 20 frames cannot be read; the first, frame 3: depth/3.png"));
  for (int i = 4; i < 7; ++i) survey.unreadable.push_back({i, "x"});
  check_faulty(said(told, nullptr, survey, "files"), "4 of 20 frames cannot be read");
  while (survey.unreadable.size() < 20) survey.unreadable.push_back({9, "x"});
  survey.depth.reset();
  CHECK(said(told, nullptr, survey, "sizes").outcome == Outcome::NotChecked);
  CHECK(said(told, nullptr, survey, "depth").outcome == Outcome::NotChecked);
}

TEST_CASE("frames that are missing: images without depth, and gaps between stamps") {
  Told told(193);
  told.without_depth = 2134;
  check_faulty(said(told, nullptr, good_survey(), "frames"),
               "2134 of 2327 colour images have no depth image");
  told.without_depth = 10;
  CHECK(said(told, nullptr, good_survey(), "frames").outcome == Outcome::Fits);
  DatasetSurvey gaps = good_survey();
  gaps.stamps.gaps = 7;
  gaps.stamps.dropped = 30;
  CHECK(contains(said(Told(193), nullptr, gaps, "frames").text, "30 more dropped in 7 gaps"));
  CHECK(said(Told(193), nullptr, gaps, "frames").outcome == Outcome::Fits);
  gaps.stamps.dropped = 100;
  check_faulty(said(Told(193), nullptr, gaps, "frames"), "are files missing?");
}

TEST_CASE("stamps that go back, and those that only number the frames") {
  DatasetSurvey survey = good_survey();
  survey.stamps.disordered = 4;
  check_faulty(said(Told(20), nullptr, survey, "stamps"), "4 of 20 stamps are not later than the one before");
  survey = good_survey();
  survey.stamps.indices = true;
  CHECK(said(Told(20), nullptr, survey, "stamps").outcome == Outcome::NotChecked);
}

TEST_CASE("implausible intrinsics and depths do not fit; nor does a dataset without depth") {
  Told told(20);
  told.camera.fx = told.camera.fy = 1;
  check_faulty(said(told, nullptr, good_survey(), "intrinsics"), "field of view of 15");
  DatasetSurvey survey = good_survey();
  survey.depth = DepthRange{0.01, 0.03, 0.1, 0.1, 0};
  check_faulty(said(Told(20), nullptr, survey, "depth"), "half of the depths are nearer than 0.03 m");
  survey.depth = DepthRange{0.12, 0.3, 0.8, 0.1, 0};
  CHECK(said(Told(20), nullptr, survey, "depth").outcome == Outcome::NotChecked);
  CHECK(contains(said(Told(20), nullptr, survey, "depth").text,
                 "if this is a room, depth_unit, 1/1000 m, is too small"));
  survey.depth.reset();
  check_faulty(said(Told(20), nullptr, survey, "depth"), "no pixel of any frame has depth");
}

TEST_CASE("poses of another clock, of none, and some") {
  Trajectory truth;
  for (int i = 0; i < 20; ++i) truth.push_back({5000.5 + i, Eigen::Isometry3d::Identity()});
  DatasetSurvey survey = good_survey();
  survey.poses = 20;
  check_faulty(said(Told(20), &truth, survey, "poses"),
               "no pose of the truth is near a frame: clocks differ by 5000.5 s (5000.500 to 5019.500 and "
               "0.000 to 19.000)");
  survey.posed = 7;
  CHECK(said(Told(20), &truth, survey, "poses").outcome == Outcome::Fits);
  CHECK(said(Told(20), &truth, survey, "poses").text == "known for 7 of 20 frames");
  survey.posed = survey.poses = 0;
  check_faulty(said(Told(20), &truth, survey, "poses"), "none of the 20 true poses is finite");
}
