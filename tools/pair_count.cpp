#include "tools/pair_count.h"

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

// As in shaders/lib/projection.glsl.
constexpr float kAlphaMin = 1.0f / 255;
constexpr float kAlphaMax = 0.99f;
constexpr float kTransmittanceMin = 1e-4f;

/// Blends one Gaussian at one pixel; a pixel that stops is left with 0.
void blend(const glsl::Splat& s, float x, float y, float* transmittance) {
  const float dx = x - s.centre.x, dy = y - s.centre.y;
  const float exponent = -0.5f * (s.conic.x * dx * dx + s.conic.z * dy * dy) - s.conic.y * dx * dy;
  const float alpha = std::min(kAlphaMax, s.opacity * std::exp(exponent));
  if (alpha < kAlphaMin) return;
  *transmittance *= 1 - alpha;
  if (*transmittance < kTransmittanceMin) *transmittance = 0;
}

/// How many of a tile's Gaussians are visited; `left` and `top` are its first pixel.
uint64_t count_visited(std::span<const glsl::Splat> list, const TileShape& shape, const ImageSize& size,
                       uint32_t left, uint32_t top) {
  const uint32_t right = std::min(left + shape.width, size.width);
  const uint32_t bottom = std::min(top + shape.height, size.height);
  std::vector<float> transmittance((right - left) * (bottom - top), 1.0f);
  for (std::size_t batch = 0; batch < list.size(); batch += shape.lanes) {
    const std::size_t end = std::min<std::size_t>(batch + shape.lanes, list.size());
    float open = 0;
    std::size_t k = 0;
    for (uint32_t y = top; y < bottom; ++y)
      for (uint32_t x = left; x < right; ++x, ++k) {
        for (std::size_t i = batch; i < end && transmittance[k] > 0; ++i)
          blend(list[i], static_cast<float>(x), static_cast<float>(y), &transmittance[k]);
        open = std::max(open, transmittance[k]);
      }
    if (open == 0) return end;
  }
  return list.size();
}

}  // namespace

uint64_t count_pairs(const TileLists& lists, const ImageSize& size) {
  const glsl::RenderStatus status = lists.read_status();
  const uint32_t tiles_x = lists.tiles_x(size), tiles = tiles_x * lists.tiles_y(size);
  const auto ranges = lists.tile_ranges.download(tiles);
  const auto gaussians = lists.tile_gaussians.download(status.instances);
  const auto splats = lists.splats.download(lists.splats.capacity());
  const TileShape& shape = lists.shape();
  uint64_t visited = 0;
  std::vector<glsl::Splat> list;
  for (uint32_t tile = 0; tile < tiles; ++tile) {
    list.clear();
    for (uint32_t i = ranges[tile].x; i < ranges[tile].y; ++i) list.push_back(splats[gaussians[i]]);
    visited += count_visited(list, shape, size, tile % tiles_x * shape.width, tile / tiles_x * shape.height);
  }
  return visited * shape.width * shape.height;
}

}  // namespace surefield
