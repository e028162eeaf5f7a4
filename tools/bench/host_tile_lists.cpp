#include "tools/bench/host_tile_lists.h"

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

// As in shaders/lib/projection.glsl.
constexpr float kAlphaMin = 1.0f / 255;
constexpr float kAlphaMax = 0.99f;
constexpr float kTransmittanceMin = 1e-4f;

/// Blends one Gaussian at one pixel, which lets light through; returns whether the pixel changes. A pixel
/// that stops is left with 0.
bool blend(const glsl::Splat& s, float x, float y, float* transmittance) {
  const float dx = x - s.centre.x, dy = y - s.centre.y;
  const float exponent = -0.5f * (s.conic.x * dx * dx + s.conic.z * dy * dy) - s.conic.y * dx * dy;
  const float alpha = std::min(kAlphaMax, s.opacity * std::exp(exponent));
  if (alpha < kAlphaMin) return false;
  *transmittance *= 1 - alpha;
  if (*transmittance >= kTransmittanceMin) return true;
  *transmittance = 0;
  return false;
}

/// Adds one tile; `left` and `top` are its first pixel.
void count_tile(const HostTileLists& lists, std::span<const glsl::uint> list, uint32_t left, uint32_t top,
                PairCount* count) {
  const uint32_t right = std::min(left + lists.shape.width, lists.size.width);
  const uint32_t bottom = std::min(top + lists.shape.height, lists.size.height);
  std::vector<float> transmittance((right - left) * (bottom - top), 1.0f);
  float open = 1;
  std::size_t visited = 0;
  while (open > 0 && visited < list.size()) {
    const auto batch = list.subspan(visited, std::min<std::size_t>(lists.shape.lanes, list.size() - visited));
    open = 0;
    std::size_t k = 0;
    for (uint32_t y = top; y < bottom; ++y)
      for (uint32_t x = left; x < right; ++x, ++k) {
        for (std::size_t i = 0; i < batch.size() && transmittance[k] > 0; ++i)
          count->blended +=
              blend(lists.splats[batch[i]], static_cast<float>(x), static_cast<float>(y), &transmittance[k]);
        open = std::max(open, transmittance[k]);
      }
    visited += batch.size();
  }
  count->processed += visited * lists.shape.width * lists.shape.height;
}

}  // namespace

HostTileLists download(const TileLists& lists, const ImageSize& size) {
  HostTileLists host{
      .shape = lists.shape(), .size = size, .tiles_x = lists.tiles_x(size), .tiles_y = lists.tiles_y(size)};
  host.ranges = lists.tile_ranges.download(uint64_t{host.tiles_x} * host.tiles_y);
  host.gaussians = lists.tile_gaussians.download(lists.read_status().instances);
  host.splats = lists.splats.download(lists.splats.capacity());
  return host;
}

PairCount count_pairs(const HostTileLists& lists) {
  PairCount count;
  for (uint32_t y = 0, tile = 0; y < lists.tiles_y; ++y)
    for (uint32_t x = 0; x < lists.tiles_x; ++x, ++tile) {
      const glsl::uvec2 range = lists.ranges[tile];
      count_tile(lists, std::span(lists.gaussians).subspan(range.x, range.y - range.x), x * lists.shape.width,
                 y * lists.shape.height, &count);
    }
  return count;
}

}  // namespace surefield
