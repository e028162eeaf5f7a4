#include "engine/eval/dataset_survey.h"

#include "tests/support/input_files.h"

using namespace surefield;

namespace {

/// Frames of one depth each, at given times.
class TimedRecording : public Recording {
 public:
  explicit TimedRecording(std::vector<double> times) : times_(std::move(times)) {}
  std::string name() const override { return "timed"; }
  std::string format() const override { return "memory"; }
  int count() const override { return static_cast<int>(times_.size()); }
  Intrinsics intrinsics() const override { return {20, 10, 10, 10, 9.5, 4.5}; }
  double depth_unit() const override { return 0.001; }
  double timestamp(int i) const override { return times_.at(static_cast<std::size_t>(i)); }
  LoadedFrame load(int i) const override {
    if (i == broken) return {std::nullopt, "broken"};
    cv::Mat depth(10, 20, CV_32FC1, cv::Scalar(1.0 + i));
    depth.colRange(0, 5).setTo(0);
    return {Frame{i, timestamp(i), cv::Mat(10, 20, CV_8UC3, cv::Scalar::all(9)), depth}, ""};
  }

  int broken = -1;

 private:
  std::vector<double> times_;
};

}  // namespace

TEST_CASE("rate, gaps and dropped frames come from the stamps") {
  const StampSurvey stamps = survey_stamps(TimedRecording({5.0, 5.1, 5.2, 5.5, 5.6, 5.7, 5.9}));
  CHECK_FALSE(stamps.indices);
  CHECK(stamps.spacing == doctest::Approx(0.1));
  CHECK(stamps.duration == doctest::Approx(0.9));
  CHECK(stamps.gaps == 2);
  CHECK(stamps.dropped == 3);
  CHECK(stamps.longest_gap == doctest::Approx(0.3));
  CHECK(stamps.disordered == 0);
  CHECK(survey_stamps(TimedRecording({0.5, 0.6, 0.6, 0.7})).disordered == 1);
  const StampSurvey numbered = survey_stamps(TimedRecording({0, 1, 2, 4}));
  CHECK(numbered.indices);
  CHECK(numbered.dropped == 1);
  CHECK(survey_stamps(TimedRecording({3.5})).spacing == 0);
}

TEST_CASE("every frame is read: broken ones are named, depths and holes counted") {
  TimedRecording recording({0.0, 0.1, 0.2, 0.3});
  recording.broken = 2;
  Trajectory truth;
  for (double time : {0.05, 0.15, 0.25}) truth.push_back({time, Eigen::Isometry3d::Identity()});
  int last = 0;
  const DatasetSurvey survey =
      survey_dataset(recording, &truth, 2.5, [&](int done) { return (last = done) > 0; });
  CHECK(last == 4);
  CHECK(survey.frames == 4);
  REQUIRE(survey.unreadable.size() == 1);
  CHECK(survey.unreadable.front().index == 2);
  CHECK(survey.unreadable.front().reason == "broken");
  CHECK(survey.posed == 2);
  REQUIRE(survey.depth);
  CHECK(survey.depth->holes == doctest::Approx(0.3));  // columns 0, 2 and 4 of ten that are looked at
  CHECK(survey.depth->near == doctest::Approx(1).epsilon(0.03));
  CHECK(survey.depth->median == doctest::Approx(2).epsilon(0.03));
  CHECK(survey.depth->far == doctest::Approx(4).epsilon(0.03));
  CHECK(survey.depth->beyond == doctest::Approx(1.0 / 3));
  CHECK(survey.poses == 3);
  CHECK(survey_dataset(recording, &truth, 2.5, [](int done) { return done < 2; }).frames == 2);
}
