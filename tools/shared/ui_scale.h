#pragma once

#include <CLI/CLI.hpp>

namespace surefield {

/// Adds --ui-scale: how many times larger than usual text and controls of a window are; 0: as the screen
/// asks.
CLI::Option* add_ui_scale_option(CLI::App& command, double& scale);

}  // namespace surefield
