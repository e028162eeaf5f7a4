#include "engine/eval/dataset_survey.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/eval/check_scene.h"
#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr double kGap = 1.5;        // times the median spacing; a longer one hides a frame
constexpr int kPixelStep = 2;       // in both directions: one pixel in four
constexpr double kSmallest = 1e-3;  // metres, the first bin
constexpr int kBinsPerDoubling = 24;
constexpr std::size_t kBins = 26 * kBinsPerDoubling;  // up to 67 km

/// Depths, counted by their logarithm: any range, the same relative precision.
class DepthHistogram {
 public:
  void add(const cv::Mat& depth) {
    for (int y = 0; y < depth.rows; y += kPixelStep) {
      const auto* line = depth.ptr<float>(y);
      for (int x = 0; x < depth.cols; x += kPixelStep) add(line[x]);
    }
  }

  std::optional<DepthSurvey> survey() const {
    if (valid_ == 0) return std::nullopt;
    const auto all = static_cast<double>(valid_ + holes_);
    return DepthSurvey{quantile(0.01), quantile(0.5), quantile(0.99), static_cast<double>(holes_) / all};
  }

 private:
  void add(float z) {
    if (!(z > 0) || !std::isfinite(z)) {
      ++holes_;
      return;
    }
    const double bin = kBinsPerDoubling * std::log2(z / kSmallest);
    ++counts_[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))];
    ++valid_;
  }

  double quantile(double share) const {
    const auto wanted = static_cast<uint64_t>(share * static_cast<double>(valid_));
    uint64_t below = 0;
    std::size_t bin = 0;
    while (bin + 1 < kBins && below + counts_[bin] <= wanted) below += counts_[bin++];
    return kSmallest * std::exp2((static_cast<double>(bin) + 0.5) / kBinsPerDoubling);
  }

  std::array<uint64_t, kBins> counts_{};
  uint64_t valid_ = 0;
  uint64_t holes_ = 0;
};

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

DatasetSurvey survey_dataset(const Recording& recording, const Trajectory* truth,
                             const std::function<bool(int)>& go_on) {
  DatasetSurvey survey;
  survey.stamps = survey_stamps(recording);
  survey.posed = count_posed(recording, truth);
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
  survey.depth = histogram.survey();
  return survey;
}

}  // namespace surefield
