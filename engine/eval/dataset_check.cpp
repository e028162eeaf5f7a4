#include "engine/eval/dataset_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/eval/check_scene.h"

namespace surefield {

namespace {

constexpr double kCertain = 4;       // standard errors
constexpr std::size_t kFewest = 4;   // pairs or frames from which anything is concluded
constexpr int kRefinements = 4;      // on each side of the best value of the grid
constexpr int kRounds = 3;           // values that are corrected one after the other
constexpr double kAssumedRate = 30;  // frames per second where stamps only count frames
// Without poses: distances from neutral that are no fault, and those that must be seen.
constexpr double kFocalTolerated = 0.12, kFocalFault = 0.26;
constexpr double kRatioTolerated = 0.06, kRatioFault = 0.2;
constexpr double kDelayTolerated = 0.028, kDelayFault = 0.06;  // seconds

/// How a value is searched for and when it counts as wrong.
struct Search {
  CheckedValue value;
  double Correction::*field;
  bool by_edges;     ///< judged by edge_strengths, else by texture_errors
  bool is_factor;    ///< the search runs over its logarithm
  double reach;      ///< largest distance from neutral
  double step;       ///< of the grid
  double tolerated;  ///< distance from neutral that is no fault
  double better;     ///< smallest improvement that counts, a fraction
  double fault;      ///< distance from neutral that must be seen, or the value counts as not judged
};

// Distances are logarithms of factors, pixels of the checked images, or seconds.
constexpr std::array<Search, 8> kSearches = {{
    {CheckedValue::DepthScale, &Correction::depth_scale, false, true, 1.8, 0.03, 0.06, 0.03, 0.22},
    {CheckedValue::FocalLength, &Correction::focal, false, true, 0.7, 0.02, 0.05, 0.03, 0.26},
    {CheckedValue::FocalRatio, &Correction::aspect, false, true, 0.48, 0.02, 0.03, 0.03, 0.2},
    {CheckedValue::PoseDelay, &Correction::pose_delay, false, false, 0.1, 0.01, 0.018, 0.03, 0.05},
    {CheckedValue::DepthFocal, &Correction::depth_focal, true, true, 0.24, 0.02, 0.035, 0.03, 0.1},
    {CheckedValue::DepthShiftX, &Correction::shift_x, true, false, 12, 1, 5, 0.03, 8},
    {CheckedValue::DepthShiftY, &Correction::shift_y, true, false, 12, 1, 5, 0.03, 8},
    {CheckedValue::DepthDelay, &Correction::depth_delay, true, false, 0.1, 0.01, 0.028, 0.02, 0.06},
}};

/// Lower is better; by pair or by frame.
using Scores = std::vector<std::optional<double>>;

/// How much better scores became, over what could be scored both times.
struct Comparison {
  std::size_t count = 0;
  double gain = 0;         ///< mean
  double improvement = 0;  ///< relative
  double certainty = 0;
};

Comparison compare(const Scores& before, const Scores& after) {
  std::vector<double> gains;
  double level = 0;
  Comparison comparison;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!before[i] || !after[i]) continue;
    gains.push_back(*before[i] - *after[i]);
    level += std::abs(*before[i]);
    comparison.gain += gains.back();
  }
  comparison.count = gains.size();
  if (gains.size() < 2 || level == 0) return comparison;
  const auto n = static_cast<double>(gains.size());
  comparison.improvement = comparison.gain / level;
  comparison.gain /= n;
  double squares = 0;
  for (double gain : gains) squares += (gain - comparison.gain) * (gain - comparison.gain);
  const double error = std::sqrt(squares / (n * (n - 1)));
  comparison.certainty = error > 0 ? comparison.gain / error : 0;
  return comparison;
}

bool is_delay(CheckedValue value) {
  return value == CheckedValue::PoseDelay || value == CheckedValue::DepthDelay;
}

class Checker {
 public:
  explicit Checker(const PreparedScene& prepared) : prepared_(prepared) {}

  /// The value of a search that fits best, all else as in `known`.
  Judgement judge(const Search& search, const Correction& known) const {
    Judgement judgement;
    judgement.value = search.value;
    const Scores neutral = scores(search, known, 0);
    std::vector<Candidate> candidates;
    for (double at = -search.reach; at < search.reach + search.step / 2; at += search.step)
      candidates.push_back(candidate(search, known, neutral, at));
    const Candidate* best = best_of(candidates);
    if (!best) return judgement;
    const double middle = best->at;
    for (int k = -kRefinements; k <= kRefinements; ++k)
      if (k != 0)
        candidates.push_back(
            candidate(search, known, neutral, middle + search.step * k / (kRefinements + 1)));
    best = best_of(candidates);
    double lower = -std::numeric_limits<double>::infinity(), upper = -lower;
    for (const Candidate& other : candidates) {
      const Comparison loss = compare(other.scores, best->scores);
      if (loss.count < kFewest || loss.improvement < search.better || loss.certainty < kCertain) continue;
      if (other.at < best->at) lower = std::max(lower, other.at);
      if (other.at > best->at) upper = std::min(upper, other.at);
    }
    judgement.judged = lower > -search.fault && upper < search.fault;
    judgement.best = value(search, best->at);
    judgement.lower = value(search, lower);
    judgement.upper = value(search, upper);
    judgement.improvement = best->comparison.improvement;
    judgement.certainty = best->comparison.certainty;
    judgement.wrong = std::abs(best->at) > search.tolerated && judgement.improvement > search.better &&
                      judgement.certainty > kCertain;
    judgement.judged = judgement.judged || judgement.wrong;
    return judgement;
  }

 private:
  struct Candidate {
    double at = 0;
    Scores scores;
    Comparison comparison;  ///< with neutral
    bool comparable = false;
  };

  Candidate candidate(const Search& search, const Correction& known, const Scores& neutral, double at) const {
    Candidate candidate{at, scores(search, known, at), {}};
    candidate.comparison = compare(neutral, candidate.scores);
    const auto scored = static_cast<std::size_t>(
        std::count_if(neutral.begin(), neutral.end(), [](const auto& score) { return score.has_value(); }));
    candidate.comparable = candidate.comparison.count >= kFewest && 2 * candidate.comparison.count >= scored;
    return candidate;
  }

  /// The one that gains most; null where none could be compared.
  static const Candidate* best_of(const std::vector<Candidate>& candidates) {
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates)
      if (candidate.comparable && (!best || candidate.comparison.gain > best->comparison.gain))
        best = &candidate;
    return best;
  }

  /// The value of the field at a distance from neutral.
  double value(const Search& search, double at) const {
    if (search.is_factor) return std::exp(at);
    return is_delay(search.value) && prepared_.stamps_are_indices ? at * kAssumedRate : at;
  }

  Scores scores(const Search& search, Correction correction, double at) const {
    correction.*search.field = value(search, at);
    if (!search.by_edges) return texture_errors(prepared_.scene, correction);
    Scores strengths = edge_strengths(prepared_.scene, correction);
    for (auto& strength : strengths) {
      if (strength) strength = -*strength;
    }
    return strengths;
  }

  const PreparedScene& prepared_;
};

/// Judges each value, corrects the one that explains most, and judges again. False where `go_on` ended it.
bool judge_all(const PreparedScene& prepared, DatasetCheck& check, const GoOn& go_on) {
  const Checker checker(prepared);
  std::array<bool, kSearches.size()> corrected{};
  for (int round = 0; round < kRounds; ++round) {
    std::size_t worst = kSearches.size();
    for (std::size_t i = 0; i < kSearches.size(); ++i) {
      if (go_on && !go_on((round + static_cast<double>(i) / kSearches.size()) / kRounds)) return false;
      if (corrected[i]) continue;
      check.judgements[i] = checker.judge(kSearches[i], check.correction);
      if (!check.judgements[i].wrong) continue;
      if (worst == kSearches.size() ||
          check.judgements[i].improvement > check.judgements[worst].improvement) {
        worst = i;
      }
    }
    if (worst == kSearches.size()) break;
    corrected[worst] = true;
    check.correction.*kSearches[worst].field = check.judgements[worst].best;
  }
  for (std::size_t i = 0; i < kSearches.size(); ++i) {
    // What was not corrected by the last round is explained by what was.
    Judgement& judgement = check.judgements[i];
    judgement.wrong = corrected[i];
    if (judgement.value != CheckedValue::DepthShiftX && judgement.value != CheckedValue::DepthShiftY)
      continue;
    for (double Judgement::*pixels : {&Judgement::best, &Judgement::lower, &Judgement::upper})
      judgement.*pixels /= prepared.scale;
  }
  return true;
}

/// A judgement from an estimate, about 0, that comes with its error.
void judge_estimate(Judgement& judgement, const Estimate& estimate, double tolerated, double fault,
                    bool is_factor) {
  const auto value = [&](double at) { return is_factor ? std::exp(at) : at; };
  judgement.best = value(estimate.value);
  judgement.lower = value(estimate.value - kCertain * estimate.error);
  judgement.upper = value(estimate.value + kCertain * estimate.error);
  judgement.certainty = std::abs(estimate.value) / estimate.error;
  judgement.wrong = std::abs(estimate.value) > tolerated && judgement.certainty > kCertain;
  judgement.judged = judgement.wrong || kCertain * estimate.error < fault - tolerated;
}

/// Judges without poses what was not judged with them.
void judge_without_poses(const Recording& recording, DatasetCheck& check, const GoOn& go_on) {
  const auto judgement = [&](CheckedValue value) -> Judgement& {
    return check.judgements[static_cast<std::size_t>(value)];
  };
  Judgement &focal = judgement(CheckedValue::FocalLength), &ratio = judgement(CheckedValue::FocalRatio);
  const auto part = [&](double begin) -> GoOn {
    return [&go_on, begin](double done) { return !go_on || go_on(begin + done / 2); };
  };
  if (!focal.judged || !ratio.judged) {
    check.lens = fit_lens(match_frames(recording, part(0)), recording.intrinsics());
    if (!focal.judged) judge_estimate(focal, check.lens.focal, kFocalTolerated, kFocalFault, true);
    if (!ratio.judged) judge_estimate(ratio, check.lens.aspect, kRatioTolerated, kRatioFault, true);
  }
  Judgement& delay = judgement(CheckedValue::DepthDelay);
  if (delay.judged) return;
  check.depth_delay = estimate_depth_delay(recording, part(0.5));
  const double frame = check.stamps_are_indices ? kAssumedRate : 1;
  judge_estimate(delay, {check.depth_delay.value, check.depth_delay.error}, kDelayTolerated * frame,
                 kDelayFault * frame, false);
}

}  // namespace

DatasetCheck check_dataset(const Recording& recording, const Trajectory* truth, const GoOn& go_on) {
  const auto part = [&](double begin) -> GoOn {
    return [&go_on, begin](double done) { return !go_on || go_on(begin + done / 2); };
  };
  const GoOn first = part(0);
  const PreparedScene prepared = prepare_scene(recording, truth, [&] { return !first(0); });
  DatasetCheck check;
  check.has_poses = !prepared.scene.track.empty();
  check.stamps_are_indices = prepared.stamps_are_indices;
  check.error = warp_error(prepared.scene);
  for (const Search& search : kSearches) check.judgements.push_back({search.value});
  if (judge_all(prepared, check, first)) judge_without_poses(recording, check, part(0.5));
  return check;
}

}  // namespace surefield
