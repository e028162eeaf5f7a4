#include "engine/eval/depth_delay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "engine/eval/check_scene.h"
#include "engine/sources/frame_stream.h"
#include "engine/types/error.h"
#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr int kDelayFrames = 24;     // spread over the sequence
constexpr int kFewestTrials = 8;     // from which anything is concluded
constexpr double kDelayCertain = 4;  // standard errors
constexpr double kTrialWidth = 320;  // pixels of the images that are compared

/// A colour image with one of the depth images that may belong to it.
struct Trial {
  double offset = 0;    ///< stamp of the depth image after that of the colour image, seconds
  double strength = 0;  ///< of the colour edges at the depth edges
};

/// The trials of one colour image: with the depth image before that of the dataset, with that, with the next.
using Trials = std::array<Trial, 3>;

bool has_depth_stamps(const Recording& recording) {
  for (int i = 0; i < recording.count(); ++i)
    if (recording.depth_timestamp(i) != recording.timestamp(i)) return true;
  return false;
}

/// Median time between frames, seconds.
double frame_period(const Recording& recording) {
  std::vector<double> periods;
  for (int i = 1; i < recording.count(); ++i)
    periods.push_back(recording.timestamp(i) - recording.timestamp(i - 1));
  return median(periods);
}

std::optional<Trial> try_frame(const Recording& recording, int i, double added) {
  const LoadedFrame loaded = recording.load(i);
  if (!loaded.frame) return std::nullopt;
  const double scale = std::min(1.0, kTrialWidth / recording.intrinsics().width);
  CheckScene scene{.intrinsics = recording.intrinsics().scaled(scale)};
  scene.frames.push_back(prepare_frame(resize_frame(*loaded.frame, scale), loaded.frame->timestamp));
  const auto strength = edge_strengths(scene, {})[0];
  if (!strength) return std::nullopt;
  return Trial{recording.depth_timestamp(i) - added - recording.timestamp(i), *strength};
}

/// The trials of frames all over the sequence, those that could be judged with all three depth images, about
/// a delay that is known so far.
std::vector<Trials> run_trials(const Recording& recording, double delay, const OpenDelayed& open) {
  const double period = frame_period(recording);
  const std::array<double, 3> added = {delay + period, delay, delay - period};
  std::array<std::unique_ptr<Recording>, 3> recordings;
  std::array<std::map<double, int>, 3> frames;  // by the stamp of the colour image
  for (int k = 0; k < 3; ++k) {
    try {
      recordings[k] = open(added[k]);
    } catch (const InputError&) {
      return {};  // nothing belongs together then
    }
    for (int i = 0; i < recordings[k]->count(); ++i) frames[k][recordings[k]->timestamp(i)] = i;
  }
  std::vector<Trials> all;
  for (int i : spread(recording.count(), kDelayFrames)) {
    Trials trials;
    bool complete = true;
    for (int k = 0; k < 3 && complete; ++k) {
      const auto frame = frames[k].find(recording.timestamp(i));
      complete = frame != frames[k].end();
      const auto trial = complete ? try_frame(*recordings[k], frame->second, added[k]) : std::nullopt;
      complete = trial.has_value();
      if (complete) trials[k] = *trial;
    }
    if (complete) all.push_back(trials);
  }
  return all;
}

Trials mean_of(const std::vector<Trials>& all) {
  Trials means;
  for (const Trials& trials : all)
    for (int k = 0; k < 3; ++k) {
      means[k].offset += trials[k].offset / static_cast<double>(all.size());
      means[k].strength += trials[k].strength / static_cast<double>(all.size());
    }
  return means;
}

/// Whether another depth image than the middle one is certainly better.
bool is_certain(const std::vector<Trials>& all, int best) {
  const Trials means = mean_of(all);
  const double gain = means[best].strength - means[1].strength;
  const auto count = static_cast<double>(all.size());
  double squares = 0;
  for (const Trials& trials : all) {
    const double own = trials[best].strength - trials[1].strength;
    squares += (own - gain) * (own - gain);
  }
  return gain > kDelayCertain * std::sqrt(squares / (count * (count - 1)));
}

/// The offset at which the parabola through three means has its top; that of the best of them where it bends
/// the other way.
double top_of(const Trials& means) {
  const auto& [a, b, c] = means;
  const double earlier = (b.strength - a.strength) / (b.offset - a.offset);
  const double later = (c.strength - b.strength) / (c.offset - b.offset);
  const double bend = (later - earlier) / (c.offset - a.offset);
  if (!(bend < 0)) return a.strength > c.strength ? a.offset : c.offset;
  return std::clamp((a.offset + b.offset) / 2 - earlier / (2 * bend), a.offset, c.offset);
}

}  // namespace

double estimate_depth_delay(const Recording& recording, const OpenDelayed& open) {
  const auto fewest = static_cast<std::size_t>(kFewestTrials);
  if (recording.count() < kFewestTrials || !has_depth_stamps(recording)) return 0;
  const std::vector<Trials> first = run_trials(recording, 0, open);
  if (first.size() < fewest) return 0;
  const Trials means = mean_of(first);
  const int best = means[0].strength > means[2].strength ? 0 : 2;
  if (!is_certain(first, best)) return 0;
  // Once more about the better one, for which it lies between two.
  const std::vector<Trials> second = run_trials(recording, -means[best].offset, open);
  return -(second.size() < fewest ? means[best].offset : top_of(mean_of(second)));
}

}  // namespace surefield
