#include "engine/session/results_folder.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <random>
#include <utility>

#include "engine/formats/map_file.h"
#include "engine/io/files.h"
#include "engine/session/folder_lock.h"
#include "engine/session/log_file.h"

namespace surefield {

namespace {

constexpr std::array kResultNames = {"trajectory.txt", "trajectory_online.txt", "keyframes.txt", "frames.csv", "loops.csv",
                                     "metrics.json",   "config.yaml",   "log.txt"};
constexpr const char* kPartial = "partial";

/// A time and a random number: an id that sorts by the beginning of the run and that no other run has.
std::string new_run_id() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 20> text{};
  std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &utc);
  std::random_device random;
  return fmt::format("{}-{:08x}", text.data(), random());
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : list_folder(folder)) names.push_back(file.filename().string());
  return names;
}

bool has_results(const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), "trajectory.txt") != names.end();
}

/// Throws InputError where a folder holds something that is not to be lost.
void require_free(const std::filesystem::path& folder) {
  if (file_exists(folder) && !folder_exists(folder)) throw InputError(folder, "is a file; give a folder");
  std::vector<std::string> names = names_in(folder);
  std::erase(names, kPartial);  // which has its own rule
  const auto strange = std::find_if_not(names.begin(), names.end(), is_result_name);
  if (strange != names.end()) {
    throw InputError(folder, "holds files that are no results of a run (" + *strange +
                                 "); give a folder of its own, or --overwrite, which writes beside them");
  }
  if (!names.empty())
    throw InputError(folder, "holds an earlier run; give another folder, or --overwrite to replace that run");
}

/// The same of the folder in which a run that did not end has left its files.
void require_no_leftover(const std::filesystem::path& partial) {
  if (has_results(names_in(partial))) {
    throw InputError(
        partial,
        "holds what a run that was ended by force has left; move it elsewhere, or give --overwrite to "
        "drop it");
  }
}

/// Removes the files that a run has written into a folder, and the folder if nothing else is in it.
void remove_results(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const std::string& name : names_in(folder))
    if (is_result_name(name)) std::filesystem::remove(folder / name, ignored);
  std::filesystem::remove(folder, ignored);
}

/// Moves a file over another, also to another disk. Throws InputError.
void move_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) {
    std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing, error);
    if (error) throw InputError(to, "cannot be written: " + error.message());
    std::filesystem::remove(from, error);
  }
  sync_to_disk(to);
}

/// Makes two folders change places at once; false where the file system cannot.
bool exchange(const std::filesystem::path& a, const std::filesystem::path& b) {
  return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

/// Moves what is nobody's result from one folder to another, where that has nothing of its name.
void move_other_files(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code ignored;
  for (const std::string& name : names_in(from))
    if (!is_result_name(name) && !file_exists(to / name))
      std::filesystem::rename(from / name, to / name, ignored);
}

}  // namespace

bool is_result_name(const std::string& name) {
  std::string whole = name;
  if (whole.ends_with(".part")) whole.resize(whole.size() - 5);
  if (whole == FolderLock::kName) return true;
  for (const std::string& format : run_map_formats())
    if (whole == "map." + format) return true;
  return std::find(kResultNames.begin(), kResultNames.end(), whole) != kResultNames.end();
}

ResultsFolder::ResultsFolder(const std::filesystem::path& folder, bool overwrite)
    : run_id_(new_run_id()), log_(std::make_unique<spdlog::logger>("surefield")) {
  std::error_code error;
  // A link leads to the folder that is swapped, and stays itself.
  folder_ = std::filesystem::weakly_canonical(std::filesystem::absolute(folder), error);
  if (error) throw InputError(folder, "cannot be used: " + error.message());
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  if (!overwrite) require_free(folder_);
  path_ = folder_.string() + "." + kPartial;
  bool made = std::filesystem::create_directories(path_, error);
  if (error && folder_exists(folder_)) {
    path_ = folder_ / kPartial;
    made = std::filesystem::create_directories(path_, error);
  }
  if (error) throw InputError(folder, "cannot be created: " + error.message());
  lock_ = std::make_unique<FolderLock>(path_);
  // Whoever had the lock may have put its results there meanwhile.
  if (!overwrite) require_free(folder_);
  if (!made && !overwrite) require_no_leftover(path_);
  for (const std::string& name : names_in(path_))
    if (name != FolderLock::kName && is_result_name(name)) std::filesystem::remove(path_ / name, error);
  log_file_ = std::make_shared<LogFile>(path_ / "log.txt");
  log_->sinks().push_back(log_file_);
  log_->set_pattern("%Y-%m-%d %H:%M:%S.%e %l: %v");
  log_->info("run {}", run_id_);
}

ResultsFolder::~ResultsFolder() {
  const bool unused = !saved_ && lock_ && lock_->is_in_place();
  std::error_code ignored;
  if (unused) std::filesystem::remove(path_ / "log.txt", ignored);
  lock_.reset();
  if (unused) std::filesystem::remove(path_, ignored);
}

void ResultsFolder::make() {
  std::error_code error;
  if (folder_exists(path_) && (!lock_ || lock_->is_in_place())) return log_file_->restore();
  std::filesystem::create_directories(path_, error);
  if (error) throw InputError(path_, "has vanished and cannot be made again: " + error.message());
  // Somebody may have removed the folder and begun another run in its place: then that one stays.
  lock_ = std::make_unique<FolderLock>(path_);
  log_->warn("{} had vanished and was made again", path_.string());
  log_file_->restore();
}

void ResultsFolder::remove(const std::string& name) {
  std::error_code ignored;
  std::filesystem::remove(path_ / name, ignored);
}

void ResultsFolder::discard() {
  if (lock_ && lock_->is_in_place()) remove_results(path_);
}

bool ResultsFolder::publish() {
  if (!problems_.empty()) return false;
  try {
    make();
    for (const std::string& name : names_in(path_)) sync_to_disk(path_ / name);
    sync_to_disk(path_);
    swap_folders();
    sync_to_disk(folder_.parent_path());
    return true;
  } catch (...) {
    note_problem(fmt::format("the results stay in {}: {}", path_.string(), describe_current_exception()));
    return false;
  }
}

void ResultsFolder::swap_folders() {
  const bool beside = path_.parent_path() == folder_.parent_path();
  std::error_code error;
  std::filesystem::create_directories(folder_.parent_path(), error);
  const bool taken = !names_in(folder_).empty();
  bool done = false;
  if (beside && !taken) {
    std::filesystem::rename(path_, folder_, error);
    done = !error;
  } else if (beside) {
    done = exchange(path_, folder_);
  }
  if (!done) return move_files();
  log_file_->moved_to(folder_ / "log.txt");
  if (lock_) lock_->moved_to(folder_);
  if (taken) {
    move_other_files(path_, folder_);
    remove_results(path_);
  }
  path_ = folder_;
}

/// Where folders cannot be swapped, as where one is a mounted disk: file by file, each over that of an
/// earlier run.
void ResultsFolder::move_files() {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const std::vector<std::string> names = names_in(path_);
  for (const std::string& name : names)
    if (name != FolderLock::kName) move_file(path_ / name, folder_ / name);
  for (const std::string& name : names_in(folder_))
    if (is_result_name(name) && std::find(names.begin(), names.end(), name) == names.end())
      std::filesystem::remove(folder_ / name, error);
  const std::filesystem::path emptied = std::exchange(path_, folder_);
  log_file_->moved_to(folder_ / "log.txt");
  lock_.reset();
  std::filesystem::remove(emptied, error);
}

void ResultsFolder::note_problem(const std::string& problem) {
  problems_.push_back(problem);
  log_->error(problem);
}

}  // namespace surefield
