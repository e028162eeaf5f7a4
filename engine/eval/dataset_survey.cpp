#include "engine/eval/dataset_survey.h"

#include <algorithm>
#include <cmath>

#include "engine/eval/check_scene.h"
#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr double kGap = 1.5;  // times the median spacing; a longer one hides a frame

int count_posed(const Recording& recording, const Trajectory* truth) {
  if (!truth) return 0;
  const PoseTrack track(*truth);
  int count = 0;
  for (int i = 0; i < recording.count(); ++i) count += track.at(recording.timestamp(i)) ? 1 : 0;
  return count;
}

}  // namespace

StampSurvey survey_stamps(const Recording& recording) {
  StampSurvey survey;
  survey.indices = stamps_are_indices(recording);
  std::vector<double> steps;
  for (int i = 1; i < recording.count(); ++i) {
    const double step = recording.timestamp(i) - recording.timestamp(i - 1);
    survey.disordered += step > 0 ? 0 : 1;
    if (step > 0) steps.push_back(step);
  }
  if (steps.empty()) return survey;
  survey.duration = recording.timestamp(recording.count() - 1) - recording.timestamp(0);
  survey.spacing = median(steps);
  for (double step : steps) {
    if (step <= kGap * survey.spacing) continue;
    ++survey.gaps;
    survey.dropped += static_cast<int>(std::lround(step / survey.spacing)) - 1;
    survey.longest_gap = std::max(survey.longest_gap, step);
  }
  return survey;
}

DatasetSurvey survey_dataset(const Recording& recording, const Trajectory* truth, double depth_max,
                             const std::function<bool(int)>& go_on) {
  DatasetSurvey survey;
  survey.stamps = survey_stamps(recording);
  survey.posed = count_posed(recording, truth);
  if (truth) {
    survey.poses = static_cast<int>(std::count_if(truth->begin(), truth->end(),
                                                  [](const StampedPose& pose) { return pose.is_finite(); }));
  }
  DepthHistogram histogram;
  FrameStream stream(recording, {});
  while (const std::optional<Frame> frame = stream.next()) {
    histogram.add(frame->depth);
    survey.frames = frame->index + 1;
    if (go_on && !go_on(survey.frames)) break;
  }
  survey.unreadable = stream.problems();
  if (!survey.unreadable.empty()) {
    survey.frames = std::max(survey.frames, survey.unreadable.back().index + 1);
  }
  survey.depth = histogram.range(depth_max);
  return survey;
}

}  // namespace surefield
