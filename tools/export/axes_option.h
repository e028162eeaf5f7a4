#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>

#include "engine/formats/mesh_axes.h"

namespace surefield {

/// Adds --axes of a mesh file; `otherwise` tells what they are without it.
inline CLI::Option* add_axes_option(CLI::App& command, std::optional<MeshAxes>& axes,
                                    const std::string& otherwise) {
  const std::map<std::string, MeshAxes> names = {
      {"world", MeshAxes::World}, {"y-up", MeshAxes::YUp}, {"z-up", MeshAxes::ZUp}};
  return command
      .add_option(
          "--axes", axes,
          "Axes of the mesh file: those of the poses (world), or upright with y or z upwards. Default: " +
              otherwise)
      ->transform(CLI::CheckedTransformer(names))
      ->option_text("world|y-up|z-up");
}

/// The axes by their name there.
inline const char* name_of(MeshAxes axes) {
  return axes == MeshAxes::World ? "world" : axes == MeshAxes::YUp ? "y-up" : "z-up";
}

}  // namespace surefield
