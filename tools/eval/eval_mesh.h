#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace surefield {

/// What `surefield eval --ground-truth-mesh` is asked to do.
struct EvalMeshOptions {
  std::string truth;  ///< mesh, PLY; empty: nothing is to be done
  std::string mesh;   ///< PLY; may be empty
  std::string map;    ///< Gaussians, PLY; may be empty
  std::string run;    ///< folder of results that mesh and map belong to; empty: they lie in the truth's frame
  std::string dataset;  ///< whose cameras cull; empty: the run's own
  std::string json;     ///< file to write; empty: none
};

/// Adds the options that only this mode has.
void add_mesh_options(CLI::App& eval, EvalMeshOptions& options);

/// Compares a mesh and the centres of a map with a true mesh; prints and writes what docs/evaluation.md
/// describes. Returns the exit code. Throws InputError.
int evaluate_mesh(const EvalMeshOptions& options);

}  // namespace surefield
