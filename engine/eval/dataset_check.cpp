#include "engine/eval/dataset_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/eval/check_scene.h"

namespace surefield {

namespace {

constexpr double kCertain = 4;       // standard errors
constexpr std::size_t kFewest = 4;   // pairs or frames from which anything is concluded
constexpr int kRefinements = 4;      // on each side of the best value of the grid
constexpr int kRounds = 3;           // values that are corrected one after the other
constexpr double kAssumedRate = 30;  // frames per second where stamps only count frames

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
};

// Distances are logarithms of factors, pixels of the checked images, or seconds.
constexpr std::array<Search, 8> kSearches = {{
    {CheckedValue::DepthScale, &Correction::depth_scale, false, true, 1.8, 0.03, 0.06, 0.03},
    {CheckedValue::FocalLength, &Correction::focal, false, true, 0.48, 0.02, 0.05, 0.03},
    {CheckedValue::FocalRatio, &Correction::aspect, false, true, 0.48, 0.02, 0.03, 0.03},
    {CheckedValue::PoseDelay, &Correction::pose_delay, false, false, 0.1, 0.01, 0.018, 0.03},
    {CheckedValue::DepthFocal, &Correction::depth_focal, true, true, 0.24, 0.02, 0.035, 0.03},
    {CheckedValue::DepthShiftX, &Correction::shift_x, true, false, 12, 1, 3.4, 0.03},
    {CheckedValue::DepthShiftY, &Correction::shift_y, true, false, 12, 1, 3.4, 0.03},
    {CheckedValue::DepthDelay, &Correction::depth_delay, true, false, 0.1, 0.01, 0.028, 0.02},
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
    Candidate best;
    for (double at = -search.reach; at <= search.reach; at += search.step) {
      consider(best, search, known, neutral, at);
    }
    const double middle = best.at;
    for (int k = -kRefinements; k <= kRefinements; ++k) {
      if (best.comparison.count == 0) break;
      consider(best, search, known, neutral, middle + search.step * k / (kRefinements + 1));
    }
    judgement.judged = best.comparison.count >= kFewest;
    judgement.best = value(search, best.at);
    judgement.improvement = best.comparison.improvement;
    judgement.certainty = best.comparison.certainty;
    judgement.wrong = judgement.judged && std::abs(best.at) > search.tolerated &&
                      judgement.improvement > search.better && judgement.certainty > kCertain;
    return judgement;
  }

 private:
  struct Candidate {
    double at = 0;
    Comparison comparison;
  };

  void consider(Candidate& best, const Search& search, const Correction& known, const Scores& neutral,
                double at) const {
    const Comparison comparison = compare(neutral, scores(search, known, at));
    const auto scored = static_cast<std::size_t>(
        std::count_if(neutral.begin(), neutral.end(), [](const auto& score) { return score.has_value(); }));
    if (comparison.count < kFewest || 2 * comparison.count < scored) return;
    if (best.comparison.count > 0 && comparison.gain <= best.comparison.gain) return;
    best = {at, comparison};
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

}  // namespace

DatasetCheck check_dataset(const Recording& recording, const Trajectory* truth,
                           const std::function<bool()>& stop) {
  const PreparedScene prepared = prepare_scene(recording, truth, stop);
  const Checker checker(prepared);
  DatasetCheck check;
  check.has_poses = !prepared.scene.track.empty();
  check.stamps_are_indices = prepared.stamps_are_indices;
  check.error = warp_error(prepared.scene);
  for (const Search& search : kSearches) check.judgements.push_back({search.value});
  std::array<bool, kSearches.size()> corrected{};
  for (int round = 0; round < kRounds; ++round) {
    std::size_t worst = kSearches.size();
    for (std::size_t i = 0; i < kSearches.size(); ++i) {
      if (stop && stop()) return check;
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
    check.judgements[i].wrong = corrected[i];
    const bool is_shift =
        kSearches[i].value == CheckedValue::DepthShiftX || kSearches[i].value == CheckedValue::DepthShiftY;
    if (is_shift) check.judgements[i].best /= prepared.scale;
  }
  return check;
}

}  // namespace surefield
