// The `surefield` command: reads the command line and runs the subcommand that it names.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "engine/types/build_info.h"
#include "engine/types/version.h"
#include "tools/shared/command.h"

namespace {

constexpr const char* kDescription =
    "Surefield: dense RGB-D SLAM with 3D Gaussians on any Vulkan device.\n"
    "\n"
    "  surefield run --dataset synthetic --out out/demo     # see it work, no data needed\n"
    "  surefield run --dataset rgbd_dataset_freiburg1_desk --out out/desk\n"
    "  surefield eval --trajectory out/desk/trajectory.txt --ground-truth rgbd_dataset_freiburg1_desk\n"
    "\n"
    "`surefield SUBCOMMAND --help` shows the options of a subcommand with an example.";

constexpr const char* kExitCodes =
    "Exit codes: 0 success, 2 wrong use or input, 3 device error, 4 done but doubtful (what matters could "
    "not be "
    "checked), 130 interrupted, 1 any other error.";

/// Adds everything that the command line may hold; parsing stores in `action` what it asks for.
void add_commands(CLI::App& program, surefield::Action& action) {
  program.footer(kExitCodes);
  program.set_version_flag(
      "--version", std::string("surefield ") + surefield::kVersion + " (" + surefield::kGitCommit + ")");
  program.require_subcommand(1);
  surefield::add_run(program, action);
  surefield::add_eval(program, action);
  surefield::add_report(program, action);
  surefield::add_tables(program, action);
  surefield::add_inspect(program, action);
  surefield::add_convert(program, action);
  surefield::add_fetch(program, action);
  surefield::add_render(program, action);
  surefield::add_view(program, action);
  surefield::add_export(program, action);
  surefield::add_graph(program, action);
  surefield::add_mesh(program, action);
  surefield::add_synth(program, action);
  surefield::add_places(program, action);
  surefield::add_vocabulary(program, action);
  surefield::add_basin(program, action);
  surefield::add_bench(program, action);
  surefield::add_devices(program, action);
}

/// What is wrong with the command line and where to look; `first` is its first argument, or empty.
std::string explain(const CLI::App& program, const std::string& first, const CLI::ParseError& error) {
  if (first.empty() || first.starts_with("-")) return std::string(error.what()) + "; see surefield --help";
  const auto is_first = [&](const CLI::App* command) { return command->get_name() == first; };
  if (!program.get_subcommands(is_first).empty()) {
    return std::string(error.what()) + "; see surefield " + first + " --help";
  }
  return "there is no subcommand " + first + "; see surefield --help";
}

/// Lavapipe, Mesa's Vulkan on the CPU, deals a kernel's workgroups out to its threads in one run each and
/// waits for the slowest. With two threads a core, a core that is free takes over from one that is held up.
/// Only where the user has not chosen; before any thread starts, since the environment is not guarded.
void share_out_cpu_work() {
  if (const unsigned cores = std::thread::hardware_concurrency())
    setenv("LP_NUM_THREADS", std::to_string(2 * cores).c_str(), 0);
}

}  // namespace

int main(int argc, char** argv) {
  share_out_cpu_work();
  CLI::App program(kDescription, "surefield");
  surefield::Action action;
  add_commands(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return program.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    surefield::print_error(explain(program, argc > 1 ? argv[1] : "", error));
    return surefield::kWrongInput;
  }
  return surefield::run_action(action);
}
