#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace surefield {

/// The nearest whole number from 0 to `most`; 0 for NaN.
inline uint32_t to_steps(double value, uint32_t most) {
  return value > 0 ? static_cast<uint32_t>(std::min(std::round(value), static_cast<double>(most))) : 0;
}

/// The nearest byte; 0 for NaN.
inline uint8_t to_byte(float value) {
  return static_cast<uint8_t>(to_steps(static_cast<double>(value), 255));
}

/// The logit of an opacity that is stored as `alpha` / 255. The bytes 0 and 255 are taken for a quarter of a
/// step inside, so that logits are finite.
inline float logit_of_byte(uint8_t alpha) {
  const float inside = std::clamp(static_cast<float>(alpha), 0.25f, 254.75f);
  return std::log(inside / (255 - inside));
}

/// The opacity of a logit, 0 to 1.
inline float opacity_of(float logit) {
  return 1 / (1 + std::exp(-logit));
}

/// The basis function of spherical harmonics of degree 0: colour = kHarmonic0 f_dc + 0.5.
constexpr float kHarmonic0 = 0.28209479177387814f;

}  // namespace surefield
