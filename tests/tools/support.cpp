#include "tests/tools/support.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <set>
#include <thread>

#include "engine/io/files.h"

namespace surefield::test {

namespace {

std::vector<std::string> with_device(std::vector<std::string> arguments) {
  const char* device = std::getenv("SUREFIELD_DEVICE");
  const std::set<std::string> users = {"run",   "render", "eval",  "report", "mesh",
                                       "synth", "bench",  "basin", "view"};
  const bool needs_one = !arguments.empty() && users.contains(arguments[0]);
  const bool has_one = std::find(arguments.begin(), arguments.end(), "--device") != arguments.end();
  if (device && needs_one && !has_one) arguments.insert(arguments.end(), {"--device", device});
  return arguments;
}

/// In the new process: `path` becomes the file that `descriptor` writes to.
void redirect(int descriptor, const char* path) {
  dup2(open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600), descriptor);
}

void limit_files(long bytes) {
  ::signal(SIGXFSZ, SIG_IGN);  // writing fails instead
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  setrlimit(RLIMIT_FSIZE, &limit);
}

}  // namespace

Program::Program(std::vector<std::string> arguments, const std::filesystem::path& folder, long file_limit)
    : out_(folder / "stdout.txt"), err_(folder / "stderr.txt") {
  arguments = with_device(std::move(arguments));
  std::vector<char*> argv = {const_cast<char*>(SUREFIELD_PROGRAM)};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  process_ = fork();
  REQUIRE(process_ >= 0);
  if (process_ > 0) return;
  redirect(STDOUT_FILENO, out_.c_str());
  redirect(STDERR_FILENO, err_.c_str());
  if (file_limit > 0) limit_files(file_limit);
  execv(SUREFIELD_PROGRAM, argv.data());
  _exit(127);
}

Program::~Program() {
  if (process_ < 0) return;
  signal(SIGKILL);
  wait();
}

void Program::signal(int number) const {
  kill(process_, number);
}

int Program::wait() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string Program::out() const {
  return read_file(out_);
}

std::string Program::err() const {
  return read_file(err_);
}

Outcome surefield_command(std::vector<std::string> arguments, const std::filesystem::path& folder) {
  Program program(std::move(arguments), folder);
  const int code = program.wait();
  return {code, program.out(), program.err()};
}

std::vector<std::string> short_run(const std::filesystem::path& out, int frames) {
  return {"run",
          "--dataset",
          "synthetic",
          "--out",
          out.string(),
          "--frames",
          std::to_string(frames),
          "--scale",
          "0.2",
          "--set",
          "first_iterations=4",
          "--set",
          "mapping_iterations=3",
          "--set",
          "adam.first_iterations=6",
          "--set",
          "adam.iterations=3",
          "--set",
          "keyframes.interval=2"};
}

void wait_for(const std::filesystem::path& file, const std::string& text) {
  for (int i = 0; i < 6000; ++i) {
    if (std::filesystem::exists(file) && contains(read_file(file), text)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  FAIL("no \"", text, "\" in ", file.string());
}

nlohmann::json read_json(const std::filesystem::path& file) {
  return nlohmann::json::parse(read_file(file));
}

void forget_files(const std::filesystem::path& run) {
  nlohmann::json metrics = read_json(run / "metrics.json");
  metrics.erase("run");
  std::ofstream(run / "metrics.json") << metrics.dump();
}

}  // namespace surefield::test
