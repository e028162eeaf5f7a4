#pragma once

#include <vector>

#include "engine/synth/scene_builder.h"

namespace surefield {

/// The materials that a scene is made of; numbers of Scene::materials.
struct Palette {
  /// Adds them all to the scene; the seed chooses among colours.
  explicit Palette(SceneBuilder& builder);

  int blank, plaster, wallpaper, brick, accent;  ///< walls
  int parquet, carpet, tiles, ceiling;           ///< floors and ceilings
  int oak, walnut, white_lacquer, black_plastic, grey_plastic, steel, brass, ceramic, cardboard, leather,
      soil, leaf, dark_leaf, bark, terracotta, rug, lamp, cloth, cushion, screen, view, white_paint;
  std::vector<int> fabrics;  ///< chairs, sofas
  std::vector<int> posters;
  std::vector<int> books;
  std::vector<int> gaudy;  ///< small things
};

}  // namespace surefield
