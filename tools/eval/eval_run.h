#pragma once

#include <string>

#include "engine/splat/engine.h"

namespace surefield {

/// What `surefield eval --run` is asked to do.
struct EvalRunOptions {
  std::string run;      ///< folder of results
  std::string dataset;  ///< where the run's own is no longer where it was; else empty
  std::string views;    ///< a dataset with true poses in the same world, see evaluate_run(); else empty
  std::string lpips;    ///< ONNX file; empty: not measured
  std::string json;     ///< file to write; empty: none
  double scale = 0;     ///< of the images that are compared, relative to the originals; 0: that of the run
  EngineOptions engine;
};

/// Measures the trajectory and the map of a finished run against its dataset, all frames of it; prints and
/// writes what docs/evaluation.md describes. With `views`, the map is also compared with all images of that
/// dataset, from its true poses. Returns the exit code. Throws InputError, gpu::Error.
int evaluate_run(const EvalRunOptions& options);

}  // namespace surefield
