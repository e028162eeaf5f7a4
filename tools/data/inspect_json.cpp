// The file that surefield inspect --json writes; the schema is described in docs/evaluation.md.
#include <cmath>

#include "tools/data/inspect_report.h"

namespace surefield {

namespace {

using Json = nlohmann::ordered_json;

const char* name(CheckedValue value) {
  switch (value) {
    case CheckedValue::DepthScale:
      return "depth_scale";
    case CheckedValue::FocalLength:
      return "focal_length";
    case CheckedValue::FocalRatio:
      return "focal_ratio";
    case CheckedValue::PoseDelay:
      return "pose_delay";
    case CheckedValue::DepthFocal:
      return "depth_focal";
    case CheckedValue::DepthShiftX:
      return "depth_shift_x";
    case CheckedValue::DepthShiftY:
      return "depth_shift_y";
    default:
      return "depth_delay";
  }
}

/// Null where it is not finite, which JSON does not know.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json survey_json(const Recording& recording, const DatasetSurvey& survey) {
  const Intrinsics k = recording.intrinsics();
  Json json = {{"schema", "surefield-inspection"},
               {"version", 1},
               {"name", recording.name()},
               {"format", recording.format()},
               {"frames", recording.count()},
               {"left_out", recording.left_out()},
               {"width", k.width},
               {"height", k.height},
               {"intrinsics", {{"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}}},
               {"depth_unit_m", recording.depth_unit()},
               {"posed_frames", survey.posed}};
  const StampSurvey& stamps = survey.stamps;
  json["stamps"] = {{"are_indices", stamps.indices},  {"spacing", stamps.spacing},
                    {"duration", stamps.duration},    {"gaps", stamps.gaps},
                    {"dropped", stamps.dropped},      {"longest_gap", stamps.longest_gap},
                    {"disordered", stamps.disordered}};
  json["depth"] = nullptr;
  if (survey.depth) {
    json["depth"] = {{"near_m", survey.depth->near},
                     {"median_m", survey.depth->median},
                     {"far_m", survey.depth->far},
                     {"holes", survey.depth->holes},
                     {"beyond_depth_max", survey.depth->beyond}};
  }
  json["unreadable"] = Json::array();
  for (const SkippedFrame& frame : survey.unreadable) {
    json["unreadable"].push_back({{"index", frame.index}, {"reason", frame.reason}});
  }
  return json;
}

Json check_json(const DatasetCheck& check) {
  Json json = {{"pairs", check.error.pairs},
               {"grey_levels", check.error.grey_levels},
               {"depth_median_m", check.error.depth_median},
               {"matched_pairs", check.lens.pairs},
               {"turn_rad", check.lens.turn}};
  for (const Judgement& judgement : check.judgements) {
    json[name(judgement.value)] = {{"judged", judgement.judged},
                                   {"wrong", judgement.wrong},
                                   {"best", number(judgement.best)},
                                   {"lower", number(judgement.lower)},
                                   {"upper", number(judgement.upper)},
                                   {"improvement", judgement.improvement},
                                   {"certainty", number(judgement.certainty)}};
  }
  return json;
}

}  // namespace

Json inspection_json(const Recording& recording, const Inspection& inspection) {
  Json json = survey_json(recording, inspection.survey);
  if (inspection.check) json["check"] = check_json(*inspection.check);
  json["topics"] = Json::array();
  for (const ListedTopic& listed : inspection.topics)
    json["topics"].push_back({{"name", listed.topic.name},
                              {"type", listed.topic.type},
                              {"encoding", listed.topic.encoding},
                              {"messages", listed.topic.messages},
                              {"use", listed.use.empty() ? Json(nullptr) : Json(listed.use)}});
  json["verdicts"] = Json::array();
  for (const Verdict& verdict : inspection.verdicts) {
    json["verdicts"].push_back(
        {{"subject", verdict.subject}, {"verdict", name(verdict.outcome)}, {"text", verdict.text}});
  }
  json["findings"] = findings_of(inspection.verdicts);
  return json;
}

}  // namespace surefield
