#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace surefield {

/// What `surefield eval --loops` is asked to do.
struct EvalLoopsOptions {
  std::string run;      ///< folder of results with loops.csv; empty: nothing is to be done
  std::string dataset;  ///< where the run's own is no longer where it was; else empty
  std::string json;     ///< file to write; empty: none
};

/// Adds the option that only this mode has; returns it.
CLI::Option* add_loop_options(CLI::App& eval, EvalLoopsOptions& options);

/// Finds what a run's keyframes see again by the true poses and depth of its dataset, and compares the loops
/// that it accepted; prints and writes what docs/evaluation.md describes. Returns the exit code. Throws
/// InputError.
int evaluate_loops(const EvalLoopsOptions& options);

}  // namespace surefield
