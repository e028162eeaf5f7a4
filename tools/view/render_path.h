#pragma once

#include "tools/view/render_options.h"

namespace surefield {

/// The paths that have names: orbit, follow, trajectory, truth.
std::vector<std::string> view_paths();

/// What can be shown over the pictures along a path: trajectory, truth, keyframes, camera, sensor.
std::vector<std::string> shown_things();

/// Renders a map along a path into films or series of PNGs, one for each mode; returns the exit code. After
/// Ctrl-C the films have what was painted. Throws InputError.
int render_path(const RenderOptions& options);

}  // namespace surefield
