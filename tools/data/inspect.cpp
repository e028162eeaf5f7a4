// surefield inspect: what a dataset is, and whether its calibration fits.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "engine/io/files.h"
#include "engine/sources/open_dataset.h"
#include "tools/data/inspect_report.h"
#include "tools/results/run_configuration.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress_line.h"

namespace surefield {

namespace {

constexpr const char* kInspectExamples =
    "Reads every frame and tells what was recognised, which files are broken, and what the depth images "
    "hold.\n"
    "Then it warps frames into later ones by the true poses, and lays depth edges on colour edges, while "
    "one\n"
    "value after the other is varied: depth scale, focal lengths, registration of depth to colour, time "
    "stamps.\n"
    "Without poses, points that frames share tell the focal lengths. Each thing fits, or does not (by how "
    "much, "
    "and\n"
    "what to change), or was not checked (why); docs/datasets.md says how.\n"
    "\n"
    "Exit code: 2 where something does not fit, 4 where neither focal length nor registration could be "
    "checked.\n"
    "\n"
    "Examples:\n"
    "  surefield inspect rgbd_dataset_freiburg1_desk\n"
    "  surefield inspect walk.mcap\n"
    "  surefield inspect my_recording --json inspection.json\n";

struct InspectOptions {
  std::string dataset;
  std::string format = "auto";
  std::string colour_topic, depth_topic;  ///< as DatasetOptions has them
  std::string json;                       ///< file to write; empty: none
};

/// The depths that a run with the built-in settings uses, and those that there can be.
DepthReach reach_of(const Recording& recording) {
  SlamSettings settings;
  load_settings(settings, {}, recording.format());
  return {settings.depth_max, reach_of(settings.sensor)};
}

DatasetSurvey survey_with_progress(const Dataset& dataset, double depth_max) {
  const Recording& recording = *dataset.recording;
  ProgressLine progress("reading");
  return survey_dataset(recording, dataset.truth(), depth_max, [&](int done) {
    progress.show(static_cast<double>(done) / recording.count(),
                  fmt::format("{}/{}", done, recording.count()));
    return !interrupted();
  });
}

DatasetCheck check_with_progress(const Dataset& dataset) {
  ProgressLine progress("comparing");
  return check_dataset(*dataset.recording, dataset.truth(), [&](double done) {
    progress.show(done, "");
    return !interrupted();
  });
}

/// Where no frame can be read, or nothing has depth, there is nothing to compare.
bool comparable(const DatasetSurvey& survey) {
  return survey.depth.has_value();
}

Inspection look_at(const Dataset& dataset) {
  const Recording& recording = *dataset.recording;
  const DepthReach reach = reach_of(recording);
  Inspection inspection{survey_with_progress(dataset, reach.limit), {}, {}, {}};
  fmt::print("{}", survey_text(recording, inspection.survey));
  std::fflush(stdout);
  inspection.verdicts = survey_verdicts(recording, dataset.truth(), inspection.survey, reach);
  if (interrupted()) return inspection;
  if (comparable(inspection.survey)) {
    DatasetCheck check = check_with_progress(dataset);
    if (interrupted()) return inspection;
    inspection.check = std::move(check);
    for (Verdict& verdict : check_verdicts(*inspection.check, recording))
      inspection.verdicts.push_back(std::move(verdict));
  } else {
    for (const char* subject :
         {"depth_scale", "focal_length", "focal_ratio", "registration", "depth_delay", "pose_delay"})
      inspection.verdicts.push_back({subject, Outcome::NotChecked, "no frame with depth can be read"});
  }
  return inspection;
}

int exit_code(const std::vector<Verdict>& verdicts) {
  if (!findings_of(verdicts).empty()) return kWrongInput;
  const bool judged = std::any_of(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) {
    return verdict.outcome == Outcome::Fits &&
           (verdict.subject == "focal_length" || verdict.subject == "registration");
  });
  return judged ? kSuccess : kDoubtful;
}

int inspect(const InspectOptions& options) {
  catch_interrupts();
  DatasetOptions dataset_options{.format = options.format};
  dataset_options.colour_topic = options.colour_topic;
  dataset_options.depth_topic = options.depth_topic;
  const std::vector<ListedTopic> topics = list_topics(options.dataset, dataset_options);
  fmt::print("{}", topics_text(topics));
  std::fflush(stdout);
  const Dataset dataset = open_dataset(options.dataset, dataset_options);
  Inspection inspection = look_at(dataset);
  inspection.topics = topics;
  if (!interrupted()) fmt::print("{}", verdicts_text(inspection.verdicts));
  if (!options.json.empty()) {
    const auto json = inspection_json(*dataset.recording, inspection);
    write_file(options.json, [&](std::ostream& stream) {
      stream << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
    });
  }
  return interrupted() ? kInterrupted : exit_code(inspection.verdicts);
}

}  // namespace

void add_inspect(CLI::App& program, Action& action) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command =
      program.add_subcommand("inspect", "Tells what a dataset holds and whether its calibration fits");
  command
      ->add_option("dataset", options->dataset,
                   "Folder of the sequence (or a .sens, .mcap, .db3 or .bag file)")
      ->required();
  command->add_option("--format", options->format, "Layout of the dataset")
      ->check(CLI::IsMember(known_formats()))
      ->capture_default_str();
  command->add_option("--colour-topic", options->colour_topic,
                      "Topic of the colour images in a log, where the one that is found is another");
  command->add_option("--depth-topic", options->depth_topic, "The same of the depth images");
  command->add_option("--json", options->json, "Also writes everything to this file");
  command->footer(kInspectExamples);
  command->callback([options, &action] { action = [options] { return inspect(*options); }; });
}

}  // namespace surefield
