// surefield inspect: what a dataset is, and whether its calibration fits.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/eval/dataset_check.h"
#include "engine/eval/dataset_survey.h"
#include "engine/io/files.h"
#include "engine/sources/open_dataset.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress_line.h"

namespace surefield {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kInspectExamples =
    "Reads every frame and tells what was recognised, which files are broken, and what the depth images "
    "hold.\n"
    "Then it warps frames into later ones by the true poses, and lays depth edges on colour edges, while "
    "one\n"
    "value after the other is varied: depth scale, focal lengths, registration of depth to colour, time "
    "stamps.\n"
    "A value that fits clearly better than the dataset's own is named, with what to change\n"
    "(docs/datasets.md).\n"
    "\n"
    "Examples:\n"
    "  surefield inspect rgbd_dataset_freiburg1_desk\n"
    "  surefield inspect my_recording --json inspection.json\n";

constexpr std::size_t kNamedFrames = 5;  // the others are in the JSON file

struct InspectOptions {
  std::string dataset;
  std::string format = "auto";
  std::string json;  ///< file to write; empty: none
};

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

/// The best value with its unit.
std::string value_text(const Judgement& judgement, bool indices) {
  switch (judgement.value) {
    case CheckedValue::PoseDelay:
    case CheckedValue::DepthDelay:
      return indices ? fmt::format("{:+.1f} frames", judgement.best)
                     : fmt::format("{:+.0f} ms", 1000 * judgement.best);
    case CheckedValue::DepthShiftX:
    case CheckedValue::DepthShiftY:
      return fmt::format("{:+.1f} px", judgement.best);
    default:
      return fmt::format("x {:.3f}", judgement.best);
  }
}

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
  if (stamps.disordered > 0) text += fmt::format("; {} stamps out of order", stamps.disordered);
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
  text += fmt::format("poses            known for {} of {} frames\n", survey.posed, recording.count());
  for (const std::string& warning : recording.warnings()) text += "note             " + warning + "\n";
  return text;
}

std::string check_text(const DatasetCheck& check, const std::vector<std::string>& findings) {
  std::string text;
  if (check.error.pairs > 0) {
    text += fmt::format("warped frames    {} pairs: {:.1f} grey levels, {:.1f} mm of depth (median)\n",
                        check.error.pairs, check.error.grey_levels, 1000 * check.error.depth_median);
  }
  for (const Judgement& judgement : check.judgements) {
    if (!judgement.judged) {
      text += fmt::format("  {:<14} cannot be judged\n", name(judgement.value));
      continue;
    }
    text += fmt::format("  {:<14} {:<12} fits best, {:.1f} % better{}\n", name(judgement.value),
                        value_text(judgement, check.stamps_are_indices), 100 * judgement.improvement,
                        judgement.wrong ? "  <- wrong" : "");
  }
  for (const std::string& finding : findings) text += "WRONG            " + finding + "\n";
  if (findings.empty()) text += "verdict          nothing wrong found\n";
  return text;
}

Json survey_json(const Recording& recording, const DatasetSurvey& survey) {
  const Intrinsics k = recording.intrinsics();
  Json json = {{"schema", "surefield-inspection"},
               {"version", 1},
               {"name", recording.name()},
               {"format", recording.format()},
               {"frames", recording.count()},
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
                     {"holes", survey.depth->holes}};
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
               {"depth_median_m", check.error.depth_median}};
  for (const Judgement& judgement : check.judgements) {
    json[name(judgement.value)] = {{"judged", judgement.judged},
                                   {"wrong", judgement.wrong},
                                   {"best", judgement.best},
                                   {"improvement", judgement.improvement},
                                   {"certainty", judgement.certainty}};
  }
  return json;
}

DatasetSurvey survey_with_progress(const Dataset& dataset) {
  const Recording& recording = *dataset.recording;
  ProgressLine progress("reading");
  return survey_dataset(recording, dataset.truth(), [&](int done) {
    progress.show(static_cast<double>(done) / recording.count(),
                  fmt::format("{}/{}", done, recording.count()));
    return !interrupted();
  });
}

int inspect(const InspectOptions& options) {
  catch_interrupts();
  const Dataset dataset = open_dataset(options.dataset, options.format);
  const Recording& recording = *dataset.recording;
  const DatasetSurvey survey = survey_with_progress(dataset);
  fmt::print("{}", survey_text(recording, survey));
  std::fflush(stdout);
  Json json = survey_json(recording, survey);
  if (!interrupted()) {
    const DatasetCheck check = check_dataset(recording, dataset.truth(), interrupted);
    const std::vector<std::string> findings = check_findings(check, recording);
    if (!interrupted()) fmt::print("{}", check_text(check, findings));
    json["check"] = check_json(check);
    json["findings"] = findings;
  }
  if (!options.json.empty()) {
    write_file(options.json, [&](std::ostream& stream) {
      stream << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
    });
  }
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace

void add_inspect(CLI::App& program, Action& action) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command =
      program.add_subcommand("inspect", "Tells what a dataset holds and whether its calibration fits");
  command->add_option("dataset", options->dataset, "Folder of the sequence (or a .sens file)")->required();
  command->add_option("--format", options->format, "Layout of the dataset")
      ->check(CLI::IsMember(known_formats()))
      ->capture_default_str();
  command->add_option("--json", options->json, "Also writes everything to this file");
  command->footer(kInspectExamples);
  command->callback([options, &action] { action = [options] { return inspect(*options); }; });
}

}  // namespace surefield
