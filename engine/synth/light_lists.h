#pragma once

#include <vector>

#include "engine/synth/scene.h"
#include "shaders/shared/synth_types.h"

namespace surefield {

/// For each light a cube of cells around it, and for each cell the bodies that can stand between the light
/// and points seen through it: so a shadow ray is tested against a handful of bodies only.
struct LightLists {
  std::vector<glsl::uvec2> cells;         ///< first of `entries` and how many, by light, face, row and column
  std::vector<glsl::LightEntry> entries;  ///< of a cell, near to far
};

LightLists make_light_lists(const Scene& scene);

}  // namespace surefield
