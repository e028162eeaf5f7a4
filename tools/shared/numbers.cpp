#include "tools/shared/numbers.h"

#include <fmt/format.h>

#include <cmath>

namespace surefield {

std::string shown(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

}  // namespace surefield
