#include "engine/types/camera.h"

#include <cmath>

namespace surefield {

Intrinsics Intrinsics::scaled(double s) const {
  return {static_cast<int>(std::lround(width * s)),
          static_cast<int>(std::lround(height * s)),
          fx * s,
          fy * s,
          s * (cx + 0.5) - 0.5,
          s * (cy + 0.5) - 0.5};
}

}  // namespace surefield
