#include "tools/report/report_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

/// From when on something is fair, and from when on bad.
struct Limits {
  double fair = 0;
  double bad = 0;
};

constexpr Limits kError{.fair = 0.01, .bad = 0.03};  // position, of the path
constexpr double kShortestPath = 0.3;                // metres; on shorter ones a share would say little
constexpr Limits kUnposed{.fair = 0.0, .bad = 0.1};  // frames without a pose, of all
constexpr Limits kDoubtfulEnd{.fair = 2, .bad = 9};  // frames at the end that are poor or lost
constexpr Limits kDepth{.fair = 0.1, .bad = 0.3};    // metres
constexpr Limits kFloaters{.fair = 0.05, .bad = 0.2};
constexpr Limits kUncovered{.fair = 0.1, .bad = 0.3};
constexpr Limits kUnlike{.fair = -15, .bad = -10};  // less than so many decibels, at each frame's exposure

/// The worst of what was judged so far.
class Judge {
 public:
  /// `value` counts from above each limit on; nan does not.
  void weigh(double value, const Limits& limits, const std::string& reason) {
    if (!(value > limits.fair)) return;
    verdict_.level = std::max(verdict_.level, value > limits.bad ? VerdictLevel::Bad : VerdictLevel::Fair);
    verdict_.reasons.push_back(reason);
  }
  void decide(VerdictLevel level, const std::string& reason) {
    verdict_.level = std::max(verdict_.level, level);
    verdict_.reasons.push_back(reason);
  }
  Verdict verdict() const { return verdict_; }

 private:
  Verdict verdict_;
};

/// Frames without a pose, of all that were read; nan where there were none.
double unposed(const ReportRun& run) {
  const double fed = run.folder.number("/frames/fed");
  const auto count = [&](const char* key) {
    const double number = run.folder.number(key);
    return std::isfinite(number) ? number : 0;
  };
  const double skipped = count("/frames/skipped");
  return (count("/frames/lost") + skipped) / (fed + skipped);
}

}  // namespace

Verdict judge(const ReportRun& run) {
  const auto number = [&](const char* pointer) { return run.folder.number(pointer); };
  Judge judge;
  const std::string status = run.folder.text("/status");
  if (status == "failed") judge.decide(VerdictLevel::Bad, "the run failed");
  if (!(number("/frames/fed") > 0)) judge.decide(VerdictLevel::Bad, "no frame was tracked");
  if (status == "interrupted" || status == "running")
    judge.decide(VerdictLevel::Fair, "the run is not complete");
  judge.weigh(unposed(run), kUnposed, "frames without a pose");
  judge.weigh(number("/frames/doubtful_end"), kDoubtfulEnd, "no certain pose at the end");
  if (run.accuracy) {
    judge.weigh(run.accuracy->ate.rmse / std::max(kShortestPath, run.path_length), kError,
                "the error of the positions");
  }
  const double same_exposure = number("/images/psnr_same_exposure_db");
  judge.weigh(-(std::isfinite(same_exposure) ? same_exposure : number("/images/psnr_db")), kUnlike,
              "renders that differ from the images");
  judge.weigh(number("/images/depth_l1_m"), kDepth, "the error of the depth");
  judge.weigh(number("/images/floaters"), kFloaters, "floaters");
  judge.weigh(1 - number("/images/coverage"), kUncovered, "holes");
  return judge.verdict();
}

const char* name_of(VerdictLevel level) {
  switch (level) {
    case VerdictLevel::Good:
      return "good";
    case VerdictLevel::Fair:
      return "fair";
    default:
      return "bad";
  }
}

std::string verdict_limits() {
  std::string text =
      fmt::format("Fair, or bad, from: an error of {:.0f} or {:.0f} % of the path (at least {:.1f} m)",
                  100 * kError.fair, 100 * kError.bad, kShortestPath);
  text += fmt::format("; any, or {:.0f} % of the frames, without a pose", 100 * kUnposed.bad);
  text += fmt::format("; {:.0f} or {:.0f} frames at the end that are poor or lost", kDoubtfulEnd.fair + 1,
                      kDoubtfulEnd.bad + 1);
  text += fmt::format("; renders {:.0f} or {:.0f} dB like the images", -kUnlike.fair, -kUnlike.bad);
  text += fmt::format("; {:.0f} or {:.0f} cm of depth error", 100 * kDepth.fair, 100 * kDepth.bad);
  text += fmt::format("; {:.0f} or {:.0f} % floaters", 100 * kFloaters.fair, 100 * kFloaters.bad);
  return text + fmt::format("; {:.0f} or {:.0f} % holes.", 100 * kUncovered.fair, 100 * kUncovered.bad);
}

}  // namespace surefield
