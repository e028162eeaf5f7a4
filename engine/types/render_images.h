#pragma once

#include <cstdint>
#include <vector>

namespace surefield {

/// Everything the renderer outputs, in host memory. Row-major, width * height entries each (colour: 3 floats
/// a pixel, RGB). Definitions: docs/method.md, "Forward".
struct RenderImages {
  int width = 0;
  int height = 0;
  std::vector<float> colour;            ///< I = sum alpha T c + (1 - O) background
  std::vector<float> opacity;           ///< O = sum alpha T
  std::vector<float> depth;             ///< D_alpha = sum alpha T z, metres
  std::vector<float> depth_normalised;  ///< D_alpha / O, 0 where O = 0
  std::vector<float>
      depth_median;  ///< z of the Gaussian at which T first falls below 0.5; 0 where there is none
  std::vector<float> uncertainty;  ///< U = sum alpha T (z - D)^2, D the sensor depth; 0 where D is invalid
  std::vector<int32_t>
      dominator;  ///< index of the Gaussian of the largest alpha T; -1 where nothing was blended
  std::vector<float> dominator_weight;  ///< that alpha T; 0 where nothing was blended
};

}  // namespace surefield
