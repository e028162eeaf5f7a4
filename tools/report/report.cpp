// surefield report: the results of runs as one HTML page.
#include <fmt/format.h>

#include <memory>

#include "engine/io/files.h"
#include "tools/report/report_sections.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"

namespace surefield {

namespace {

constexpr const char* kReportExamples =
    "Writes one HTML file that needs nothing else, no network either: how good each run was, trajectories "
    "against\n"
    "the truth, errors, tracking and map size frame by frame, time per stage, renders against the sensor's "
    "images,\n"
    "all measures (docs/evaluation.md) and the settings. Several runs are shown side by side.\n"
    "The datasets are read where the runs found them; a report without them lacks errors over time and "
    "images.\n"
    "\n"
    "Examples:\n"
    "  surefield report out/desk --out desk.html\n"
    "  surefield report out/base out/no_isotropy --out compare.html --frames 0,120,240\n"
    "  surefield report out/desk --dataset /data/rgbd_dataset_freiburg1_desk --out desk.html\n";

struct ReportOptions {
  std::vector<std::string> runs;
  std::string out = "report.html";
  std::string dataset;
  ImageOptions images;
};

int report(const ReportOptions& options) {
  catch_interrupts();
  const std::vector<ReportRun> runs = load_report_runs(options.runs, options.dataset);
  const std::string page = report_page(runs, options.images);
  write_file(options.out, [&](std::ostream& stream) { stream << page; });
  fmt::print("{} ({:.1f} MB)\n", options.out, static_cast<double>(page.size()) / 1e6);
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = program.add_subcommand("report", "Shows runs and their quality as one HTML page");
  command->add_option("runs", options->runs, "Folders of results of surefield run")
      ->required()
      ->type_name("RUN");
  command->add_option("--out", options->out, "HTML file to write")->capture_default_str();
  command->add_option("--dataset", options->dataset,
                      "Folder of the dataset of all runs, where it is no longer where it was");
  command
      ->add_option("--frames", options->images.frames,
                   "Frames whose images are shown, by their index in the dataset; default: three, spread out")
      ->delimiter(',');
  command->add_option("--device", options->images.engine.device,
                      "Number or part of the name of the device, see surefield devices; default: the best");
  command->footer(kReportExamples);
  command->callback([options, &action] { action = [options] { return report(*options); }; });
}

}  // namespace surefield
