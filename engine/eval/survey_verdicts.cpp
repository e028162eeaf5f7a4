// What reading a dataset says about it, in words.
#include <fmt/format.h>

#include <cmath>

#include "engine/eval/verdicts.h"

namespace surefield {

namespace {

constexpr double kMostUnreadable = 0.1;  // of the frames
constexpr double kMostLeftOut = 0.1;     // of the images listed
constexpr double kMostDropped = 0.25;  // of the frames that should have been recorded: some cameras drop many
constexpr double kMostDisordered = 0.01;  // of the stamps
constexpr double kTableTop = 1;           // metres; rooms are larger

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

bool readable(const DatasetSurvey& survey) {
  return static_cast<int>(survey.unreadable.size()) < survey.frames;
}

Verdict files_verdict(const DatasetSurvey& survey) {
  const std::size_t bad = survey.unreadable.size();
  if (bad == 0) return {"files", Outcome::Fits, fmt::format("all of {} frames can be read", survey.frames)};
  const SkippedFrame& first = survey.unreadable.front();
  const std::string text = fmt::format("{} of {} frames cannot be read; the first, frame {}: {}", bad,
                                       survey.frames, first.index, first.reason);
  const bool few = static_cast<double>(bad) <= kMostUnreadable * survey.frames;
  return {"files", few ? Outcome::Fits : Outcome::DoesNotFit, text};
}

Verdict sizes_verdict(const Recording& recording, const DatasetSurvey& survey) {
  if (!readable(survey)) return {"sizes", Outcome::NotChecked, "no frame can be read"};
  const Intrinsics k = recording.intrinsics();
  return {"sizes", Outcome::Fits,
          fmt::format("colour, depth and intrinsics are of {} x {} pixels", k.width, k.height)};
}

Verdict frames_verdict(const Recording& recording, const DatasetSurvey& survey) {
  const int count = recording.count(), left_out = recording.left_out(), dropped = survey.stamps.dropped;
  const double listed = count + left_out, recorded = count + dropped;
  if (left_out > kMostLeftOut * listed) {
    return {
        "frames", Outcome::DoesNotFit,
        fmt::format("{} of {:.0f} colour images have no depth image near them in time and are left out; are "
                    "depth images missing, or are their stamps of another clock?",
                    left_out, listed)};
  }
  std::string text = fmt::format("{} frames", count);
  if (left_out > 0) text += fmt::format(", {} colour images without depth left out", left_out);
  if (dropped > 0) text += fmt::format(", {} more dropped in {} gaps", dropped, survey.stamps.gaps);
  if (dropped > kMostDropped * recorded) {
    return {"frames", Outcome::DoesNotFit, text + "; are files missing? Tracking loses its way over gaps"};
  }
  return {"frames", Outcome::Fits, text};
}

Verdict stamps_verdict(const Recording& recording, const DatasetSurvey& survey) {
  const StampSurvey& stamps = survey.stamps;
  if (stamps.disordered > kMostDisordered * recording.count()) {
    return {
        "stamps", Outcome::DoesNotFit,
        fmt::format("{} of {} stamps are not later than the one before; frames are out of order or stamped "
                    "twice",
                    stamps.disordered, recording.count())};
  }
  if (stamps.indices) return {"stamps", Outcome::NotChecked, "the stamps only number the frames"};
  std::string text = fmt::format("{:.1f} frames a second over {:.1f} s",
                                 stamps.spacing > 0 ? 1 / stamps.spacing : 0, stamps.duration);
  if (stamps.disordered > 0) text += fmt::format(", {} not later than the one before", stamps.disordered);
  return {"stamps", Outcome::Fits, text};
}

Verdict intrinsics_verdict(const Recording& recording) {
  const std::vector<std::string> findings = implausible(recording.intrinsics());
  if (!findings.empty()) return {"intrinsics", Outcome::DoesNotFit, joined(findings)};
  return {"intrinsics", Outcome::Fits, "field of view and centre are as of a depth camera"};
}

Verdict depth_verdict(const Recording& recording, const DatasetSurvey& survey, const DepthReach& reach) {
  if (!readable(survey)) return {"depth", Outcome::NotChecked, "no frame can be read"};
  if (!survey.depth) return {"depth", Outcome::DoesNotFit, "no pixel of any frame has depth"};
  const std::vector<std::string> findings = implausible(*survey.depth, recording.depth_unit(), reach);
  if (!findings.empty()) return {"depth", Outcome::DoesNotFit, joined(findings)};
  if (survey.depth->far < kTableTop) {
    return {"depth", Outcome::NotChecked,
            fmt::format(
                "{:.2f} to {:.2f} m is as of a table top; if this is a room, depth_unit, {} m, is too small",
                survey.depth->near, survey.depth->far, unit_text(recording.depth_unit()))};
  }
  std::string text =
      fmt::format("{:.2f} to {:.2f} m is as of a depth camera", survey.depth->near, survey.depth->far);
  if (reach.limit > 0)
    text += fmt::format("; {:.1f} % lie beyond depth_max, {:g} m", 100 * survey.depth->beyond, reach.limit);
  return {"depth", Outcome::Fits, text};
}

/// The times of the truth beside those of the frames.
std::string clocks_text(const Recording& recording, const Trajectory& truth) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const StampedPose& pose : truth) {
    if (!pose.is_finite()) continue;
    first = std::min(first, pose.timestamp);
    last = std::max(last, pose.timestamp);
  }
  const double begin = recording.timestamp(0), end = recording.timestamp(recording.count() - 1);
  const std::string ranges = fmt::format("{:.3f} to {:.3f} and {:.3f} to {:.3f}", first, last, begin, end);
  if (first <= end && last >= begin) {
    return fmt::format("their times, {}, overlap, but the poses are too far apart", ranges);
  }
  return fmt::format("clocks differ by {:.6g} s ({})", std::abs(first - begin), ranges);
}

Verdict poses_verdict(const Recording& recording, const Trajectory* truth, const DatasetSurvey& survey) {
  if (!truth || truth->empty()) return {"poses", Outcome::NotChecked, "there are no true poses"};
  if (survey.poses == 0) {
    return {"poses", Outcome::DoesNotFit,
            fmt::format("none of the {} true poses is finite; the evaluation has nothing", truth->size())};
  }
  if (survey.posed == 0) {
    return {"poses", Outcome::DoesNotFit,
            "no pose of the truth is near a frame: " + clocks_text(recording, *truth)};
  }
  return {"poses", Outcome::Fits, fmt::format("known for {} of {} frames", survey.posed, recording.count())};
}

}  // namespace

const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::Fits:
      return "fits";
    case Outcome::DoesNotFit:
      return "does_not_fit";
    default:
      return "not_checked";
  }
}

std::vector<Verdict> survey_verdicts(const Recording& recording, const Trajectory* truth,
                                     const DatasetSurvey& survey, const DepthReach& reach) {
  return {files_verdict(survey),
          sizes_verdict(recording, survey),
          frames_verdict(recording, survey),
          stamps_verdict(recording, survey),
          intrinsics_verdict(recording),
          depth_verdict(recording, survey, reach),
          poses_verdict(recording, truth, survey)};
}

std::vector<std::string> findings_of(const std::vector<Verdict>& verdicts) {
  std::vector<std::string> findings;
  for (const Verdict& verdict : verdicts)
    if (verdict.outcome == Outcome::DoesNotFit) findings.push_back(verdict.text);
  return findings;
}

}  // namespace surefield
