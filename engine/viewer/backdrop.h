#pragma once

#include <span>

#include "engine/viewer/view_painter.h"

namespace surefield {

/// What is shown where the map is not.
enum class Backdrop {
  Squares,  ///< of two dark greys: nothing that a map would hold
  Dark,
  Light,
  Black
};

/// A backdrop as people name it.
struct BackdropInfo {
  Backdrop backdrop;
  const char* name;
};

/// All, in the order of the enumeration.
std::span<const BackdropInfo> backdrops();

/// The one after it, round in a circle.
Backdrop next_backdrop(Backdrop backdrop);

/// Puts it behind the map.
void set_backdrop(ViewSettings& settings, Backdrop backdrop);

}  // namespace surefield
