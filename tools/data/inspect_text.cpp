// What surefield inspect prints.
#include <fmt/format.h>

#include "tools/data/inspect_report.h"

namespace surefield {

namespace {

constexpr std::size_t kNamedFrames = 5;  // the others are in the JSON file

std::string stamps_text(const StampSurvey& stamps) {
  std::string text;
  if (stamps.indices) {
    text = "unknown, the stamps number the frames";
  } else {
    text = fmt::format("{:.1f} frames/s, {:.1f} s", stamps.spacing > 0 ? 1 / stamps.spacing : 0,
                       stamps.duration);
  }
  if (stamps.gaps > 0) {
    text += fmt::format("; {} frames dropped in {} gaps, the longest {:.3g} {}", stamps.dropped, stamps.gaps,
                        stamps.longest_gap, stamps.indices ? "frames" : "s");
  } else {
    text += "; none dropped";
  }
  return text;
}

}  // namespace

std::string topics_text(const std::vector<ListedTopic>& topics) {
  std::string text;
  for (const ListedTopic& listed : topics) {
    const std::string use = listed.use.empty() ? "" : "  <- " + listed.use;
    text += fmt::format("{:<16} {}  {}, {} messages{}\n", text.empty() ? "topics" : "", listed.topic.name,
                        listed.topic.type, listed.topic.messages, use);
  }
  return text;
}

std::string survey_text(const Recording& recording, const DatasetSurvey& survey) {
  const Intrinsics k = recording.intrinsics();
  std::string text = fmt::format("dataset          {}, format {}\n", recording.name(), recording.format());
  text += fmt::format("frames           {}, {} x {}\n", recording.count(), k.width, k.height);
  for (std::size_t i = 0; i < survey.unreadable.size() && i < kNamedFrames; ++i) {
    text += fmt::format("unreadable       frame {}: {}\n", survey.unreadable[i].index,
                        survey.unreadable[i].reason);
  }
  if (survey.unreadable.size() > kNamedFrames) {
    text += fmt::format("                 and {} more\n", survey.unreadable.size() - kNamedFrames);
  }
  text += "rate             " + stamps_text(survey.stamps) + "\n";
  text +=
      fmt::format("intrinsics       fx {:.6g}, fy {:.6g}, cx {:.6g}, cy {:.6g}\n", k.fx, k.fy, k.cx, k.cy);
  if (survey.depth) {
    text +=
        fmt::format("depth            {:.2f} to {:.2f} m (1 to 99 %), median {:.2f} m, {:.1f} % holes\n",
                    survey.depth->near, survey.depth->far, survey.depth->median, 100 * survey.depth->holes);
  } else {
    text += "depth            none\n";
  }
  for (const std::string& warning : recording.warnings()) text += "note             " + warning + "\n";
  return text;
}

std::string verdicts_text(const std::vector<Verdict>& verdicts) {
  constexpr std::pair<Outcome, const char*> kKinds[] = {
      {Outcome::Fits, "fits"}, {Outcome::NotChecked, "not checked"}, {Outcome::DoesNotFit, "DOES NOT FIT"}};
  std::string text;
  for (const auto& [outcome, title] : kKinds) {
    for (const Verdict& verdict : verdicts) {
      if (verdict.outcome != outcome) continue;
      text += fmt::format("{:<16} {}: {}\n", title, verdict.subject, verdict.text);
    }
  }
  return text;
}

}  // namespace surefield
