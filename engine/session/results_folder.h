#pragma once

#include <spdlog/logger.h>

#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/types/error.h"

namespace surefield {

class FolderLock;
class LogFile;

/// The folder of a run's results with its log, log.txt. Until publish() everything is written into a folder
/// beside it, `folder`.partial (or `folder`/partial, where nothing can be made beside it), which other
/// processes are kept out of; then the two are swapped, so that the folder holds the whole of one run at any
/// time, and an earlier run stays until there is another. One thread at a time, but for the log.
class ResultsFolder {
 public:
  /// Throws InputError where it cannot be written to, where another run is writing there, and unless
  /// `overwrite` where it holds anything: an earlier run, what a run that was killed has left, or files of
  /// somebody else, which are kept in any case.
  explicit ResultsFolder(const std::filesystem::path& folder, bool overwrite = false);
  /// What was not published stays in the folder beside, unless no file was saved.
  ~ResultsFolder();
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  /// Has `write` write one file, which is named as it is in the folder; a failure is logged and kept in
  /// problems(), so that the other files are written all the same. The folder is made again if it has
  /// vanished.
  template <typename Write>
  void save(const std::string& name, Write write) {
    try {
      make();
      write(path_ / name);
      saved_ = true;
    } catch (...) {
      note_problem(name + " is not saved: " + describe_current_exception());
    }
  }
  /// Removes a file that an earlier save() wrote.
  void remove(const std::string& name);

  /// Removes what is there: nothing was computed. For a program that ends at once, whatever other threads do.
  void discard();

  /// Puts what was saved into the place of the results, after the disk has it; does nothing where something
  /// could not be saved. Returns whether it is there.
  bool publish();

  spdlog::logger& log() { return *log_; }
  /// Where files are saved now.
  const std::filesystem::path& path() const { return path_; }
  /// The same in all files of one run, and in no other's.
  const std::string& run_id() const { return run_id_; }
  /// What could not be saved and why, one line each.
  const std::vector<std::string>& problems() const { return problems_; }
  /// Forgets them: what a checkpoint could not save, a later one may.
  void forget_problems() { problems_.clear(); }

 private:
  void make();
  void note_problem(const std::string& problem);
  void swap_folders();
  void move_files();

  std::filesystem::path folder_;
  std::filesystem::path path_;
  std::string run_id_;
  std::unique_ptr<FolderLock> lock_;
  std::shared_ptr<LogFile> log_file_;
  std::unique_ptr<spdlog::logger> log_;
  std::vector<std::string> problems_;
  bool saved_ = false;
};

/// The names of the files that a run writes.
bool is_result_name(const std::string& name);

}  // namespace surefield
