#pragma once

#include "engine/splat/engine.h"
#include "engine/splat/tile_lists.h"

namespace surefield {

/// A frame's images on the device.
struct SensorFrame {
  ImageSize size;
  gpu::Array<glsl::uint> colour;  ///< R, G, B, 255 from the lowest byte up
  gpu::Array<float>
      depth;  ///< metres, 0 where invalid, negative where the pixel shows nothing to compare with
  uint32_t valid_pixels = 0;  ///< pixels with depth
  glsl::vec3 noise{};         ///< of the depth: constant, linear and quadratic part (DepthNoise)

  /// Without a frame yet.
  explicit SensorFrame(gpu::Device& device);
  SensorFrame(gpu::Device& device, const FrameView& view);

  /// Makes room for frames of that size.
  void reserve(const ImageSize& room);
  /// Puts a frame in the place of the one before.
  void assign(const FrameView& view);
};

}  // namespace surefield
