#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace surefield {

/// A frame's images in host memory, without loss: colour in three bytes a pixel; depth in two, as the place
/// in a list of the values that occur, which are few where a sensor counts in millimetres, else in four.
class PackedImages {
 public:
  /// Colour with R, G, B, 255 from the lowest byte up; depth in metres, of as many pixels.
  PackedImages(std::span<const uint32_t> colour, std::span<const float> depth);

  std::vector<uint32_t> colour() const;
  std::vector<float> depth() const;
  /// Host memory of the pixels.
  uint64_t bytes() const;

 private:
  std::vector<uint8_t> rgb_;
  std::vector<float> depths_;     ///< the values that occur; where they are too many, of every pixel
  std::vector<uint16_t> places_;  ///< per pixel, in `depths_`; empty where they are too many
};

}  // namespace surefield
