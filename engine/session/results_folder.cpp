#include "engine/session/results_folder.h"

#include <spdlog/sinks/basic_file_sink.h>

namespace surefield {

ResultsFolder::ResultsFolder(const std::filesystem::path& folder) : path_(folder), log_("surefield") {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder, "cannot be created: " + error.message());
  try {
    log_.sinks().push_back(
        std::make_shared<spdlog::sinks::basic_file_sink_mt>((folder / "log.txt").string(), true));
  } catch (const spdlog::spdlog_ex&) {
    throw InputError(folder, "cannot be written to; check its permissions");
  }
  log_.set_pattern("%Y-%m-%d %H:%M:%S.%e %l: %v");
  log_.flush_on(spdlog::level::info);
  // A log that cannot be written on is no reason to stop.
  log_.set_error_handler([](const std::string&) {});
}

void ResultsFolder::note_problem(const std::string& problem) {
  problems_.push_back(problem);
  log_.error(problem);
}

}  // namespace surefield
