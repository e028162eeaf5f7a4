#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/splat/engine.h"

namespace surefield {

/// What `surefield basin` is asked to do.
struct BasinOptions {
  std::string run;                       ///< folder of results
  std::string dataset;                   ///< where the run's own is no longer where it was; else empty
  int frames = 10;                       ///< spread over the run, at most
  uint32_t seed = 1;                     ///< of the directions in which poses are disturbed
  std::vector<std::string> assignments;  ///< "key=value", applied to the run's settings
  std::string json;                      ///< file to write; empty: none
  EngineOptions engine;
};

/// Tracks frames of a finished run from disturbed poses, by every method, in the run's map, which stays as it
/// is; prints and writes what docs/evaluation.md describes, also that of the frames so far when the user
/// interrupts. Returns the exit code. Throws InputError, gpu::Error.
int measure_basin(const BasinOptions& options);

}  // namespace surefield
