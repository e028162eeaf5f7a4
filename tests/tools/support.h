#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/input_files.h"

namespace surefield::test {

/// The `surefield` program, running. Its device is the one that the environment variable SUREFIELD_DEVICE
/// names, where the arguments start with a command that takes one.
class Program {
 public:
  /// Starts it; what it prints goes to files in `folder`. `file_limit`, in bytes, is the largest file that it
  /// can write (0: no limit), as on a full disk.
  Program(std::vector<std::string> arguments, const std::filesystem::path& folder, long file_limit = 0);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const;
  /// Waits for its end; returns the exit code, or -1 where it was killed.
  int wait();

  std::string out() const;
  std::string err() const;

 private:
  std::filesystem::path out_;
  std::filesystem::path err_;
  pid_t process_ = -1;
};

/// How a run of the program ended.
struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

/// Runs the program to its end.
Outcome surefield_command(std::vector<std::string> arguments, const std::filesystem::path& folder);

/// The arguments of a run over the embedded sequence that is as short as can be, with results in `out`.
std::vector<std::string> short_run(const std::filesystem::path& out, int frames = 3);

/// Waits until a file holds a text, at most a minute.
void wait_for(const std::filesystem::path& file, const std::string& text);

nlohmann::json read_json(const std::filesystem::path& file);

/// Makes of the results of a run those of an older version, whose metrics.json does not tell what its files
/// hold: a test may change them then.
void forget_files(const std::filesystem::path& run);

}  // namespace surefield::test
