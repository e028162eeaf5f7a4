#include "engine/eval/depth_delay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "engine/eval/check_scene.h"
#include "engine/sources/frame_stream.h"
#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr double kTrialWidth = 640;  // pixels of the images that are compared; coarser ones tell less
constexpr int kTrials = 40;          // in all
// The error is by leaving out one part of the recording after the other. Neighbouring frames err alike.
constexpr int kMostParts = 10, kFewestParts = 4;
constexpr int kPartLength = 12;              // frames, at least
constexpr int kTrialStep = 2;                // frames from one trial to the next, at most
constexpr int kTrialReach = 3;               // frames to the first and last depth image of a trial
constexpr std::size_t kFewestTrials = 8;     // from which anything is concluded
constexpr std::size_t kFewestStrengths = 5;  // of a trial
// Frame periods.
constexpr double kMostDelay = 1.8;
constexpr double kGridStep = 0.06;
constexpr std::array<double, 8> kWidths = {0.25, 0.36, 0.53, 0.75, 1.1, 1.5, 2.1, 3};
constexpr double kPrior = 0.5;       // standard deviation
constexpr double kDelayCertain = 2;  // standard errors
constexpr double kFaintest = 0.02;   // of the mean contrast: a lower bell tells nothing
// Of the depth images against the colour images.
constexpr double kShiftStep = 1.0 / 640;  // of the image's width
constexpr int kMostShift = 9;             // steps
constexpr int kCoarse = 3;                // steps; the best of these is where the search begins

double frame_period(const Recording& recording) {
  std::vector<double> periods;
  for (int i = 1; i < recording.count(); ++i)
    periods.push_back(recording.timestamp(i) - recording.timestamp(i - 1));
  return periods.empty() ? 0 : median(periods);
}

/// A colour image and the depth images about it, by the time from the colour image to them.
struct Trial {
  cv::Mat contrast;
  std::map<double, std::vector<DepthPoint>> rims;  ///< by frame periods
};

/// The trials of one part of the recording.
using Part = std::vector<Trial>;

/// Loads images, each once while it is needed.
class TrialLoader {
 public:
  TrialLoader(const Recording& recording, double period) : recording_(recording), period_(period) {}

  /// The trial of frame `i`; nothing where too few images about it can be read or have edges.
  std::optional<Trial> trial(int i) {
    images_.erase(images_.begin(), images_.lower_bound(i - kTrialReach));
    Trial trial{images(i).contrast, {}};
    if (trial.contrast.empty()) return std::nullopt;
    for (int j = std::max(0, i - kTrialReach); j <= std::min(i + kTrialReach, recording_.count() - 1); ++j) {
      const double offset = (recording_.depth_timestamp(j) - recording_.timestamp(i)) / period_;
      const std::vector<DepthPoint>& rims = images(j).rims;
      // Another image may have the same stamp: a depth image may belong to two frames.
      if (std::abs(offset) < kTrialReach + 1 && mean_contrast(trial.contrast, rims, {}))
        trial.rims[offset] = rims;
    }
    if (trial.rims.size() < kFewestStrengths) return std::nullopt;
    return trial;
  }

 private:
  struct Images {
    cv::Mat contrast;  ///< empty where the frame cannot be read
    std::vector<DepthPoint> rims;
  };

  const Images& images(int i) {
    const auto known = images_.find(i);
    if (known != images_.end()) return known->second;
    Images images;
    if (const LoadedFrame loaded = recording_.load(i); loaded.frame) {
      const Frame frame =
          resize_frame(*loaded.frame, std::min(1.0, kTrialWidth / recording_.intrinsics().width));
      images = {edge_contrast(frame.colour), depth_rims(frame.depth)};
    }
    return images_.emplace(i, std::move(images)).first->second;
  }

  const Recording& recording_;
  double period_;
  std::map<int, Images> images_;
};

/// A bell over the time between colour and depth image.
struct Bell {
  double top = 0;    ///< frame periods
  double width = 1;  ///< frame periods
};

std::vector<Bell> all_bells() {
  std::vector<Bell> bells;
  for (double width : kWidths)
    for (double top = -kMostDelay; top < kMostDelay + kGridStep / 2; top += kGridStep)
      bells.push_back({top, width});
  return bells;
}

/// How strengths go with a bell: sums over trials, each about its own mean.
struct Fit {
  double together = 0;
  double bell = 0;

  /// The strengths' variation that the bell explains; none where it would be too low, or a dip.
  double explained() const { return height() > kFaintest ? together * together / bell : 0; }
  /// Of the bell, where 1 is the mean contrast.
  double height() const { return bell > 0 ? together / bell : 0; }
  Fit& operator+=(const Fit& other) {
    together += other.together;
    bell += other.bell;
    return *this;
  }
  Fit operator-(const Fit& other) const { return {together - other.together, bell - other.bell}; }
};

/// How strong a trial's colour edges are at the depth edges, over time.
struct Curve {
  std::vector<double> offsets, values;
};

Fit fit(const Curve& curve, const Bell& bell) {
  const auto n = static_cast<double>(curve.values.size());
  double mean = 0, bell_mean = 0;
  std::array<double, 2 * kTrialReach + 1> bells{};
  for (std::size_t k = 0; k < curve.values.size(); ++k) {
    const double x = (curve.offsets[k] - bell.top) / bell.width;
    bells[k] = std::exp(-0.5 * x * x);
    mean += curve.values[k] / n;
    bell_mean += bells[k] / n;
  }
  Fit sums;
  for (std::size_t k = 0; k < curve.values.size(); ++k) {
    sums.together += (curve.values[k] - mean) * (bells[k] - bell_mean);
    sums.bell += (bells[k] - bell_mean) * (bells[k] - bell_mean);
  }
  return sums;
}

/// The bell that explains most.
struct Top {
  double at = 0;         ///< frame periods
  double explained = 0;  ///< 0 where the best is at the end of the range
};

/// Fits bells while all depth images are shifted by the same.
class DelayFitter {
 public:
  explicit DelayFitter(const std::vector<Part>& parts) : parts_(parts) {}

  /// Frame periods, and the standard error; NaN where nothing fits. By depth images that are shifted as fits
  /// best: a camera that moves one way makes a shift look like a delay, and one that moves to and fro tells
  /// them apart.
  std::pair<double, double> top() {
    const Shift best = best_shift(kAll);
    const double at = top(best, kAll).at;
    // Shift and delay are told apart by motion that changes. Where they go together, half of what the shift
    // has done to the delay is in doubt.
    const Top unshifted = top({0, 0}, kAll);
    const double doubt = unshifted.explained > 0 ? (at - unshifted.at) / 2 : 0;
    return {between(best, kAll), std::sqrt(by_parts() + by_shifts(best, at) + doubt * doubt)};
  }

 private:
  using Shift = std::array<int, 2>;  ///< right and down, kShiftStep
  static constexpr int kAll = -1;    ///< in place of the part that is left out

  /// The sums for each part and bell, and over all parts.
  struct Sums {
    std::vector<std::vector<Fit>> parts;
    std::vector<Fit> whole;
  };

  /// All shifts from which a search may begin.
  static std::vector<Shift> coarse_shifts() {
    std::vector<Shift> shifts;
    for (int y = -kMostShift; y <= kMostShift; y += kCoarse)
      for (int x = -kMostShift; x <= kMostShift; x += kCoarse) shifts.push_back({x, y});
    return shifts;
  }

  Shift best_shift(int without) {
    Shift best{};
    const auto try_shift = [&](const Shift& shift) {
      if (std::abs(shift[0]) > kMostShift || std::abs(shift[1]) > kMostShift) return false;
      if (!(top(shift, without).explained > top(best, without).explained)) return false;
      best = shift;
      return true;
    };
    for (const Shift& shift : coarse_shifts()) try_shift(shift);
    for (bool better = true; better;) {
      better = false;
      const Shift from = best;
      for (const Shift& step : {Shift{-1, 0}, Shift{1, 0}, Shift{0, -1}, Shift{0, 1}})
        better = try_shift({from[0] + step[0], from[1] + step[1]}) || better;
    }
    return best;
  }

  /// The top at a shift that is refined between whole steps, along each direction.
  double between(const Shift& best, int without) {
    const Top middle = top(best, without);
    if (middle.explained == 0) return std::numeric_limits<double>::quiet_NaN();
    double at = middle.at;
    for (int axis = 0; axis < 2; ++axis) {
      Shift before = best, after = best;
      --before[axis];
      ++after[axis];
      const Top a = top(before, without), c = top(after, without);
      const double bend = a.explained - 2 * middle.explained + c.explained;
      if (a.explained == 0 || c.explained == 0 || !(bend < 0)) continue;
      at += std::clamp(0.5 * (a.explained - c.explained) / bend, -0.5, 0.5) * (c.at - a.at) / 2;
    }
    return at;
  }

  /// The squared error by the jackknife: by how much the top changes where one part is left out.
  double by_parts() {
    std::vector<double> tops;
    for (int part = 0; part < static_cast<int>(parts_.size()); ++part)
      tops.push_back(between(best_shift(part), part));
    return jackknife(tops);
  }

  /// The squared error by not knowing the shift: how far the tops at other shifts lie, each counted by how
  /// well it cannot be told from the best.
  double by_shifts(const Shift& best, double at) {
    double weights = 1, squares = 0;
    for (const Shift& shift : coarse_shifts()) {
      const Top other = top(shift, kAll);
      if (shift == best || other.explained == 0) continue;
      std::vector<double> losses;
      for (int part = 0; part < static_cast<int>(parts_.size()); ++part)
        losses.push_back(top(best, part).explained - top(shift, part).explained);
      const double loss = top(best, kAll).explained - other.explained, variance = jackknife(losses);
      const double weight = variance > 0 ? std::exp(-0.5 * loss * loss / variance) : 0;
      weights += weight;
      squares += weight * (other.at - at) * (other.at - at);
    }
    return squares / weights;
  }

  /// The squared standard error of a value, by those where one part is left out.
  static double jackknife(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0, squares = 0;
    for (double value : values) mean += value / n;
    for (double value : values) squares += (value - mean) * (value - mean);
    return squares * (n - 1) / n;
  }

  const Sums& sums(const Shift& shift) {
    const auto known = known_.find(shift);
    if (known != known_.end()) return known->second;
    Sums sums{{parts_.size(), std::vector<Fit>(bells_.size())}, std::vector<Fit>(bells_.size())};
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (const Trial& trial : parts_[p]) {
        const Curve curve = strengths(trial, shift);
        for (std::size_t k = 0; k < bells_.size(); ++k) sums.parts[p][k] += fit(curve, bells_[k]);
      }
      for (std::size_t k = 0; k < bells_.size(); ++k) sums.whole[k] += sums.parts[p][k];
    }
    return known_.emplace(shift, std::move(sums)).first->second;
  }

  static Curve strengths(const Trial& trial, const Shift& shift) {
    Curve curve;
    const double pixel = kShiftStep * trial.contrast.cols;
    for (const auto& [offset, rims] : trial.rims) {
      const auto value = mean_contrast(trial.contrast, rims, {pixel * shift[0], pixel * shift[1]});
      if (!value) continue;
      curve.offsets.push_back(offset);
      curve.values.push_back(*value);
    }
    return curve;
  }

  /// Between the grid's places by a parabola.
  Top top(const Shift& shift, int without) {
    const Sums& all = sums(shift);
    std::vector<double> explained;
    for (std::size_t k = 0; k < bells_.size(); ++k) {
      const Fit fit =
          without < 0 ? all.whole[k] : all.whole[k] - all.parts[static_cast<std::size_t>(without)][k];
      explained.push_back(fit.explained());
    }
    const auto best =
        static_cast<std::size_t>(std::max_element(explained.begin(), explained.end()) - explained.begin());
    if (best == 0 || best + 1 == bells_.size()) return {};
    const double width = bells_[best].width;
    if (bells_[best - 1].width != width || bells_[best + 1].width != width) return {};
    const double before = explained[best - 1], after = explained[best + 1];
    const double bend = before - 2 * explained[best] + after;
    return {bells_[best].top + (bend < 0 ? kGridStep * 0.5 * (before - after) / bend : 0), explained[best]};
  }

  const std::vector<Part>& parts_;
  const std::vector<Bell> bells_ = all_bells();
  std::map<Shift, Sums> known_;
};

/// Trials from the middles of equal parts of the recording; nothing where `go_on` ended it.
std::vector<Part> load_parts(const Recording& recording, double period,
                             const std::function<bool(double)>& go_on) {
  const long count = recording.count();
  const long wanted = std::clamp<long>(count / kPartLength, kFewestParts, kMostParts);
  const int trials = kTrials / static_cast<int>(wanted);
  std::vector<Part> parts;
  TrialLoader loader(recording, period);
  for (long p = 0; p < wanted; ++p) {
    if (go_on && !go_on(static_cast<double>(p) / static_cast<double>(wanted))) return {};
    const auto begin = static_cast<int>(p * count / wanted), end = static_cast<int>((p + 1) * count / wanted);
    const int step = std::clamp((end - begin) / trials, 1, kTrialStep);
    const int first = std::max(begin, (begin + end - step * trials) / 2);
    Part part;
    for (int i = first; i < end && i < first + step * trials; i += step)
      if (auto trial = loader.trial(i)) part.push_back(std::move(*trial));
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

double DepthDelay::usable() const {
  if (!known() || std::abs(value) < kDelayCertain * error) return 0;
  const double prior = kPrior * period;
  return value * prior * prior / (prior * prior + error * error);
}

bool has_depth_stamps(const Recording& recording) {
  for (int i = 0; i < recording.count(); ++i)
    if (recording.depth_timestamp(i) != recording.timestamp(i)) return true;
  return false;
}

DepthDelay estimate_depth_delay(const Recording& recording, const std::function<bool(double)>& go_on) {
  DepthDelay delay;
  delay.period = frame_period(recording);
  if (!(delay.period > 0)) return delay;
  const std::vector<Part> parts = load_parts(recording, delay.period, go_on);
  std::size_t count = 0;
  for (const Part& part : parts) count += part.size();
  if (count < kFewestTrials) return delay;
  const auto [top, error] = DelayFitter(parts).top();
  if (std::isnan(top) || std::isnan(error)) return delay;
  delay.value = -top * delay.period;
  delay.error = error * delay.period;
  return delay;
}

}  // namespace surefield
