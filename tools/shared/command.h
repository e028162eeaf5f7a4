#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace surefield {

/// The exit codes of the program.
enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,      ///< any error that is none of those below
  kWrongInput = 2,   ///< the command line, a file or a value is wrong
  kDeviceError = 3,  ///< no usable Vulkan device, or it failed
  kDoubtful = 4,     ///< done, but what matters could not be checked
  kInterrupted = 130
};

/// What the subcommand that the user gave does; returns the exit code. Errors are thrown: run_action() prints
/// them.
using Action = std::function<int()>;

/// Each adds one subcommand with its options to the program. When the user gives it, parsing stores in
/// `action` what to do; nothing is done while parsing.
void add_devices(CLI::App& program, Action& action);
void add_run(CLI::App& program, Action& action);
void add_eval(CLI::App& program, Action& action);
void add_inspect(CLI::App& program, Action& action);
void add_fetch(CLI::App& program, Action& action);
void add_render(CLI::App& program, Action& action);
void add_view(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_tables(CLI::App& program, Action& action);
void add_export(CLI::App& program, Action& action);
void add_graph(CLI::App& program, Action& action);
void add_mesh(CLI::App& program, Action& action);
void add_synth(CLI::App& program, Action& action);
void add_convert(CLI::App& program, Action& action);
void add_places(CLI::App& program, Action& action);
void add_vocabulary(CLI::App& program, Action& action);
void add_basin(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action);

/// What --format of a dataset may be: "auto" and dataset_formats().
std::vector<std::string> known_formats();

/// Runs an action. Whatever it throws becomes one line "surefield: error: ..." on stderr and the exit code
/// that fits.
int run_action(const Action& action);

/// The exit code for the exception that is being handled.
int exit_code_of_current_exception();

/// Prints "surefield: error: `message`" to stderr.
void print_error(const std::string& message);

}  // namespace surefield
