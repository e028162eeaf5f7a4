#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace surefield {

/// The size of the pictures of a film, pixels; zero: not chosen.
struct PictureSize {
  int width = 0;
  int height = 0;
};

/// Adds an option that takes a size such as 1280x720.
CLI::Option* add_size_option(CLI::App& command, const std::string& name, PictureSize& size,
                             const std::string& help);

}  // namespace surefield
