#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/viewer/view_painter.h"

namespace surefield {

/// The colours of a scale, from its low end to its high end: RGBA bytes, R lowest.
inline constexpr std::size_t kPaletteSize = 256;
/// Those that a mode paints values in; empty where it paints none.
std::vector<uint32_t> palette_of(ViewMode mode);

/// What the colours of a picture mean.
struct Legend {
  std::string title;  ///< the quantity, with its unit
  double low = 0;     ///< the value at the low end, in that unit, as the next
  double high = 1;
  std::vector<double> ticks;      ///< round values between the two, ascending
  std::vector<std::string> text;  ///< of each tick
  std::vector<uint32_t> palette;  ///< kPaletteSize
};

/// That of a picture with these settings; nullopt where its colours are no scale.
std::optional<Legend> legend_of(const ViewSettings& settings);

/// The ends of the scale of a mode's values: metres, or for Opacity and Error shares of 1.
std::pair<float, float> scale_of(const ViewSettings& settings);

}  // namespace surefield
