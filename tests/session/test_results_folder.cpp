#include "engine/session/results_folder.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "engine/io/files.h"
#include "engine/session/folder_lock.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

void write(ResultsFolder& results, const std::string& name, const std::string& content) {
  results.save(name,
               [&](const auto& file) { write_file(file, [&](std::ostream& stream) { stream << content; }); });
}

/// Publishes a run whose trajectory is `content`.
void publish(const std::filesystem::path& folder, const std::string& content, bool overwrite = false) {
  ResultsFolder results(folder, overwrite);
  write(results, "trajectory.txt", content);
  REQUIRE(results.publish());
}

/// Does it in a process of its own that is ended by force afterwards.
void do_and_die(const std::function<void()>& work) {
  const pid_t process = fork();
  if (process == 0) {
    work();
    _exit(0);  // no destructor runs
  }
  int status = 0;
  REQUIRE(waitpid(process, &status, 0) == process);
}

}  // namespace

TEST_CASE("results appear as a whole, and an earlier run stays until then") {
  const TemporaryFolder folder;
  const auto out = folder / "run";
  {
    ResultsFolder results(out);
    write(results, "trajectory.txt", "first");
    CHECK_FALSE(file_exists(out));
    CHECK(read_file(folder / "run.partial/trajectory.txt") == "first");
    CHECK(results.publish());
    CHECK(results.path() == out);
    results.log().info("still the same log");
  }
  CHECK(read_file(out / "trajectory.txt") == "first");
  CHECK(contains(read_file(out / "log.txt"), "still the same log"));
  CHECK_FALSE(file_exists(folder / "run.partial"));
  CHECK_FALSE(file_exists(out / FolderLock::kName));

  CHECK(contains(input_error([&] { ResultsFolder again(out); }), "holds an earlier run"));
  ResultsFolder second(out, true);
  write(second, "trajectory.txt", "second");
  CHECK(read_file(out / "trajectory.txt") == "first");
  CHECK(second.publish());
  CHECK(read_file(out / "trajectory.txt") == "second");
  CHECK_FALSE(file_exists(folder / "run.partial"));
}

TEST_CASE("a run that computed nothing leaves an earlier one, and nothing of its own") {
  const TemporaryFolder folder;
  publish(folder / "run", "first");
  { ResultsFolder nothing(folder / "run", true); }
  CHECK(read_file(folder / "run/trajectory.txt") == "first");
  CHECK_FALSE(file_exists(folder / "run.partial"));
}

TEST_CASE("what could not be saved is not put into place") {
  const TemporaryFolder folder;
  publish(folder / "run", "first");
  {
    ResultsFolder results(folder / "run", true);
    write(results, "trajectory.txt", "second");
    results.save("map.ply", [](const auto&) { throw InputError("the disk is full"); });
    CHECK_FALSE(results.publish());
    REQUIRE(results.problems().size() == 1);
    CHECK(results.problems().front() == "map.ply is not saved: the disk is full");
  }
  CHECK(read_file(folder / "run/trajectory.txt") == "first");
  CHECK(read_file(folder / "run.partial/trajectory.txt") == "second");
}

TEST_CASE("somebody else's files are told from a run's, and stay") {
  const TemporaryFolder folder;
  folder.write("run/notes.txt", "mine");
  folder.write("run/sub/picture.png", "mine too");
  const std::string refusal = input_error([&] { ResultsFolder results(folder / "run"); });
  CHECK(contains(refusal, "no results of a run (notes.txt)"));
  CHECK_FALSE(file_exists(folder / "run.partial"));
  publish(folder / "run", "first", true);
  publish(folder / "run", "second", true);
  CHECK(read_file(folder / "run/notes.txt") == "mine");
  CHECK(read_file(folder / "run/sub/picture.png") == "mine too");
  CHECK(read_file(folder / "run/trajectory.txt") == "second");
  CHECK_FALSE(file_exists(folder / "run.partial"));
  CHECK(contains(input_error([&] { ResultsFolder file(folder.write("file", "")); }),
                 "file: is a file; give a folder"));
}

TEST_CASE("a second run is kept out as long as the first one lives") {
  const TemporaryFolder folder;
  {
    const ResultsFolder first(folder / "run");
    CHECK(is_locked(folder / "run.partial"));
    const std::string refusal = input_error([&] { ResultsFolder second(folder / "run"); });
    CHECK(contains(refusal, "another run is writing there"));
    CHECK(contains(input_error([&] { ResultsFolder second(folder / "run", true); }),
                   "another run is writing there"));
    CHECK(is_locked(folder / "run.partial"));
  }
  CHECK_FALSE(is_locked(folder / "run.partial"));
  publish(folder / "run", "next");
}

TEST_CASE("what a killed run has left is not dropped unasked, unless it is nothing") {
  const TemporaryFolder folder;
  do_and_die([&] { new ResultsFolder(folder / "run"); });
  REQUIRE(file_exists(folder / "run.partial"));
  publish(folder / "run", "first");

  do_and_die([&] { write(*new ResultsFolder(folder / "other"), "trajectory.txt", "half"); });
  CHECK(contains(input_error([&] { ResultsFolder next(folder / "other"); }), "ended by force"));
  CHECK(read_file(folder / "other.partial/trajectory.txt") == "half");
  publish(folder / "other", "whole", true);
  CHECK_FALSE(file_exists(folder / "other.partial"));
}

TEST_CASE("a folder that vanishes is made again, with the log from the beginning") {
  const TemporaryFolder folder;
  ResultsFolder results(folder / "deep/run");
  results.log().info("the first line");
  std::filesystem::remove_all(folder / "deep");
  write(results, "trajectory.txt", "first");
  CHECK(is_locked(folder / "deep/run.partial"));
  CHECK(results.publish());
  CHECK(read_file(folder / "deep/run/trajectory.txt") == "first");
  CHECK(contains(read_file(folder / "deep/run/log.txt"), "the first line"));
}

TEST_CASE("a run whose folder was removed, and taken by another run, leaves that alone") {
  const TemporaryFolder folder;
  {
    ResultsFolder old(folder / "run");
    write(old, "trajectory.txt", "old");
    std::filesystem::remove_all(folder / "run.partial");
    ResultsFolder other(folder / "run");
    write(other, "trajectory.txt", "other");
    write(old, "trajectory.txt", "old again");
    CHECK(old.problems().size() == 1);
    CHECK(contains(old.problems().front(), "another run is writing there"));
    CHECK(read_file(folder / "run.partial/trajectory.txt") == "other");
    CHECK_FALSE(old.publish());
    old.discard();
    CHECK(other.publish());
  }
  CHECK(read_file(folder / "run/trajectory.txt") == "other");
}

TEST_CASE("a link to a folder stays a link") {
  const TemporaryFolder folder;
  publish(folder / "real", "first");
  std::filesystem::create_directory_symlink("real", folder / "link");
  publish(folder / "link", "second", true);
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(read_file(folder / "real/trajectory.txt") == "second");
}

TEST_CASE("each run has an id of its own, which its log begins with") {
  const TemporaryFolder folder;
  ResultsFolder a(folder / "a"), b(folder / "b");
  CHECK(a.run_id() != b.run_id());
  CHECK(contains(read_file(a.path() / "log.txt"), "run " + a.run_id()));
}

TEST_CASE("names of results are told from others") {
  for (const char* name :
       {"trajectory.txt", "map.ply", "map.spz", "metrics.json", "metrics.json.part", "log.txt"})
    CHECK(is_result_name(name));
  for (const char* name : {"notes.txt", "map.glb", "trajectory.txt.bak", ".part", ""})
    CHECK_FALSE(is_result_name(name));
}
