#pragma once

#include <spdlog/logger.h>

#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/types/error.h"

namespace surefield {

/// The folder of a run's results with its log, log.txt. One thread at a time, but for the log.
class ResultsFolder {
 public:
  /// Makes the folder where there is none. Throws InputError where it cannot be written to.
  explicit ResultsFolder(const std::filesystem::path& folder);

  /// Has `write` write one file, which is named as it is in the folder; a failure is logged and kept in
  /// problems(), so that the other files are written all the same.
  template <typename Write>
  void save(const std::string& name, Write write) {
    try {
      write(path_ / name);
    } catch (...) {
      note_problem(name + " is not saved: " + describe_current_exception());
    }
  }

  spdlog::logger& log() { return log_; }
  const std::filesystem::path& path() const { return path_; }
  /// What could not be saved and why, one line each.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void note_problem(const std::string& problem);

  std::filesystem::path path_;
  spdlog::logger log_;
  std::vector<std::string> problems_;
};

}  // namespace surefield
