#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/splat/engine.h"
#include "tools/report/report_data.h"

namespace surefield {

/// Stands for a number that a run does not have.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The parts of a report, each as HTML; empty where the runs have nothing to show.

/// How good each run was in one sentence, with a colour; then the key figures, of a single run as cards, of
/// several as a table.
std::string verdict_section(const std::vector<ReportRun>& runs);

/// Tables of all measures over runs.
std::string summary_section(const std::vector<ReportRun>& runs);

/// Trajectories along their principal axes, one pair of plots per dataset.
std::string trajectory_section(const std::vector<ReportRun>& runs);

/// Errors, tracking, size of the map and time, frame by frame.
std::string progress_section(const std::vector<ReportRun>& runs);

/// The places that looked known: which were taken for true, drawn between the keyframes that saw them, and
/// what the corrections did to the error. Throws InputError for a loops.csv that is damaged.
std::string loop_section(const std::vector<ReportRun>& runs);

/// Which frames to show as images.
struct ImageOptions {
  std::vector<int> frames;  ///< indices in the dataset; empty: a few spread ones
  EngineOptions engine;
};

/// Sensor images, renders and their differences, one block per dataset and frame. Throws InputError for a
/// frame that a run has not fed, gpu::Error.
std::string image_section(const std::vector<ReportRun>& runs, const ImageOptions& options);

/// The settings: those that differ between runs side by side, then all of each run.
std::string configuration_section(const std::vector<ReportRun>& runs);

/// The seed that a run had, as its configuration says.
std::string seed_of(const ReportRun& run);

/// The settings in which a run differs from the defaults of its dataset's format, its seed aside, for people;
/// empty where there are none.
std::string changed_settings(const ReportRun& run);

/// Runs of one dataset.
struct RunGroup {
  std::string dataset;
  std::vector<int> runs;  ///< positions, which also choose the colours
};

/// The runs by dataset, in the order of their first run.
std::vector<RunGroup> group_by_dataset(const std::vector<ReportRun>& runs);

/// The whole page.
std::string report_page(const std::vector<ReportRun>& runs, const ImageOptions& options);

}  // namespace surefield
