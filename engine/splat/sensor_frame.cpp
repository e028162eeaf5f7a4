#include "engine/splat/sensor_frame.h"

#include <cmath>

namespace surefield {

SensorFrame::SensorFrame(gpu::Device& device)
    : colour(device, "sensor colour"), depth(device, "sensor depth") {}

SensorFrame::SensorFrame(gpu::Device& device, const FrameView& view) : SensorFrame(device) {
  assign(view);
}

void SensorFrame::reserve(const ImageSize& room) {
  colour.reserve(room.pixels());
  depth.reserve(room.pixels());
}

void SensorFrame::assign(const FrameView& view) {
  size = {static_cast<uint32_t>(view.width), static_cast<uint32_t>(view.height)};
  valid_pixels = 0;
  std::vector<glsl::uint> packed(size.pixels());
  std::vector<float> metres(size.pixels(), 0.0f);
  for (uint64_t i = 0; i < size.pixels(); ++i) {
    const uint8_t* rgb = view.colour + 3 * i;
    packed[i] = rgb[0] | uint32_t{rgb[1]} << 8 | uint32_t{rgb[2]} << 16 | 0xFF000000u;
    if (view.depth[i] > 0 && std::isfinite(view.depth[i])) {
      metres[i] = view.depth[i];
      ++valid_pixels;
    }
  }
  noise = {static_cast<float>(view.noise.constant), static_cast<float>(view.noise.linear),
           static_cast<float>(view.noise.quadratic)};
  colour.upload(packed);
  depth.upload(metres);
}

}  // namespace surefield
