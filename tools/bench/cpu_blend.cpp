#include "tools/bench/cpu_blend.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>
#include <utility>

namespace surefield {

/// A tile as the loop takes it.
struct alignas(64) CpuTile {
  /// A Gaussian as the loop over pixels takes it.
  struct Stamp {
    float x, y;        ///< centre, pixels
    float xx, xy, yy;  ///< log2 of exp(-d^T conic d / 2), by dx dx, dx dy and dy dy
    float log_opacity;
    float red, green, blue, depth, slope_x, slope_y;
  };

  // Pixels; one that has stopped has a transmittance of 0. Arrays that lie a multiple of 4096 bytes apart
  // would make a processor mistake a load from one for a load of what was just stored to another.
  static constexpr std::size_t kMost = CpuBlender::kMostPixels + 16;
  float x[kMost], y[kMost], transmittance[kMost], opacity[kMost];
  float depth[kMost], red[kMost], green[kMost], blue[kMost];
  std::size_t pixels = 0;  ///< so many of them

  std::vector<Stamp> stamps;  ///< near to far
  std::size_t batch = 1;      ///< Gaussians after which is looked whether all pixels have stopped
};

namespace {

using Stamp = CpuTile::Stamp;

// As in shaders/lib/projection.glsl.
constexpr float kLogAlphaMin = -7.99435344f;  // log2 of 1/255
constexpr float kAlphaMax = 0.99f;
constexpr float kTransmittanceMin = 1e-4f;

Stamp stamp_of(const glsl::Splat& s) {
  constexpr float kLog2E = 1.4426950408889634f;
  return {s.centre.x,
          s.centre.y,
          -0.5f * kLog2E * s.conic.x,
          -kLog2E * s.conic.y,
          -0.5f * kLog2E * s.conic.z,
          std::log2(s.opacity),
          s.colour.x,
          s.colour.y,
          s.colour.z,
          s.depth,
          s.slope.x,
          s.slope.y};
}

#define SUREFIELD_ALWAYS_INLINE inline __attribute__((always_inline))

/// 2^x for x from -126 to 0, to 1e-7 of it, without branches; something for any other x. The polynomial is
/// 2^x's Chebyshev interpolation on [-1/2, 1/2], and adding 1.5 * 2^23 leaves the nearest integer in the
/// lowest bits.
SUREFIELD_ALWAYS_INLINE float exp2_of(float x) {
  constexpr float kRound = 12582912.0f;
  const float shifted = x + kRound;
  const float f = x - (shifted - kRound);
  const float p =
      1.00000008f +
      f * (0.69314719f + f * (0.24022107f + f * (0.055503571f + f * (0.0096760319f + f * 0.0013390863f))));
  return __builtin_bit_cast(float,
                            __builtin_bit_cast(uint32_t, p) + (__builtin_bit_cast(uint32_t, shifted) << 23));
}

/// Puts one Gaussian (a copy: it overlaps no pixel) in front of the first `count` pixels of the tile.
SUREFIELD_ALWAYS_INLINE void blend_stamp(const Stamp s, std::size_t count, CpuTile& t) {
  for (std::size_t k = 0; k < count; ++k) {
    const float dx = t.x[k] - s.x, dy = t.y[k] - s.y;
    const float log_alpha = s.log_opacity + dx * (s.xx * dx + s.xy * dy) + s.yy * dy * dy;
    const float raw = exp2_of(log_alpha);
    const float clamped = raw < kAlphaMax ? raw : kAlphaMax;
    const float alpha = log_alpha < kLogAlphaMin ? 0.0f : clamped;
    const float share = alpha * t.transmittance[k];
    const float left = t.transmittance[k] - share;
    const float goes_on = left < kTransmittanceMin ? 0.0f : 1.0f;  // one choice: two would become branches
    const float weight = goes_on * share;
    t.transmittance[k] = goes_on * left;
    t.opacity[k] += weight;
    t.depth[k] += weight * (s.depth + s.slope_x * dx + s.slope_y * dy);
    t.red[k] += weight * s.red;
    t.green[k] += weight * s.green;
    t.blue[k] += weight * s.blue;
  }
}

/// Blends the tile's Gaussians in batches, as the kernels do, until no pixel lets light through.
SUREFIELD_ALWAYS_INLINE void blend_list(CpuTile& t) {
  const Stamp* const list = t.stamps.data();
  const std::size_t length = t.stamps.size();
  float open = 1;
  for (std::size_t begin = 0; begin < length && open > 0; begin += t.batch) {
    const std::size_t end = begin + t.batch < length ? begin + t.batch : length;
    for (std::size_t i = begin; i < end; ++i) {
      if (t.pixels == 64)
        blend_stamp(list[i], 64, t);  // the usual tile: a bound that the compiler knows
      else
        blend_stamp(list[i], t.pixels, t);
    }
    open = 0;
    for (std::size_t k = 0; k < t.pixels; ++k) open = t.transmittance[k] > open ? t.transmittance[k] : open;
  }
}

void blend_as_compiled(CpuTile& tile) {
  blend_list(tile);
}

#if defined(__x86_64__)
#if defined(__clang__)
#define SUREFIELD_WIDEST
#else
#define SUREFIELD_WIDEST ",prefer-vector-width=512"
#endif
__attribute__((target("avx2,fma"))) void blend_avx2(CpuTile& tile) {
  blend_list(tile);
}

__attribute__((target("avx2,fma,avx512f,avx512dq,avx512bw,avx512vl" SUREFIELD_WIDEST))) void blend_avx512(
    CpuTile& tile) {
  blend_list(tile);
}

bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
}
#endif

/// Blends tiles one after the other.
class TileBlender {
 public:
  TileBlender(const HostTileLists& lists, const CpuKernel& kernel, CpuImages& images)
      : lists_(lists), images_(images), kernel_(kernel) {
    tile_.pixels = std::size_t{lists.shape.width} * lists.shape.height;
    tile_.batch = lists.shape.lanes;
  }

  void blend(uint32_t column, uint32_t row) {
    const uint32_t left = column * lists_.shape.width, top = row * lists_.shape.height;
    start(left, top);
    const glsl::uvec2 range = lists_.ranges[std::size_t{row} * lists_.tiles_x + column];
    tile_.stamps.clear();
    for (uint32_t i = range.x; i < range.y; ++i)
      tile_.stamps.push_back(stamp_of(lists_.splats[lists_.gaussians[i]]));
    kernel_.blend(tile_);
    store(left, top);
  }

 private:
  void start(uint32_t left, uint32_t top) {
    const uint32_t width = lists_.shape.width;
    for (std::size_t k = 0; k < tile_.pixels; ++k) {
      const auto x = static_cast<uint32_t>(left + k % width), y = static_cast<uint32_t>(top + k / width);
      tile_.x[k] = static_cast<float>(x);
      tile_.y[k] = static_cast<float>(y);
      tile_.transmittance[k] = x < lists_.size.width && y < lists_.size.height ? 1.0f : 0.0f;
      tile_.opacity[k] = tile_.depth[k] = 0;
      tile_.red[k] = tile_.green[k] = tile_.blue[k] = 0;
    }
  }

  void store(uint32_t left, uint32_t top) {
    const uint32_t columns = std::min(lists_.shape.width, lists_.size.width - left);
    const uint32_t rows = std::min(lists_.shape.height, lists_.size.height - top);
    for (uint32_t y = 0; y < rows; ++y) {
      const std::size_t from = std::size_t{y} * lists_.shape.width;
      const std::size_t to = std::size_t{top + y} * lists_.size.width + left;
      const auto copy = [&](const float* pixels, std::vector<float>& image) {
        std::copy_n(pixels + from, columns, image.begin() + static_cast<std::ptrdiff_t>(to));
      };
      copy(tile_.red, images_.red);
      copy(tile_.green, images_.green);
      copy(tile_.blue, images_.blue);
      copy(tile_.opacity, images_.opacity);
      copy(tile_.depth, images_.depth);
    }
  }

  const HostTileLists& lists_;
  CpuImages& images_;
  CpuKernel kernel_;
  CpuTile tile_;
};

}  // namespace

std::vector<CpuKernel> cpu_kernels() {
  std::vector<CpuKernel> kernels;
#if defined(__x86_64__)
  if (has_avx512()) kernels.push_back({"AVX-512", blend_avx512});
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    kernels.push_back({"AVX2", blend_avx2});
#endif
  if (kernels.empty()) kernels.push_back({"as compiled", blend_as_compiled});
  return kernels;
}

CpuBlender::CpuBlender(HostTileLists lists) : lists_(std::move(lists)) {
  for (auto* image : {&images_.red, &images_.green, &images_.blue, &images_.opacity, &images_.depth})
    image->resize(lists_.size.pixels());
}

const CpuImages& CpuBlender::blend(const CpuKernel& kernel) {
  std::atomic<uint32_t> next{0};
  const auto work = [&] {
    TileBlender blender(lists_, kernel, images_);
    const uint32_t tiles = lists_.tiles_x * lists_.tiles_y;
    constexpr uint32_t kChunk = 16;  // tiles taken at a time
    for (uint32_t begin = next.fetch_add(kChunk); begin < tiles; begin = next.fetch_add(kChunk))
      for (uint32_t tile = begin; tile < std::min(begin + kChunk, tiles); ++tile)
        blender.blend(tile % lists_.tiles_x, tile / lists_.tiles_x);
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < threads(); ++i) others.emplace_back(work);
  work();
  others.clear();  // waits for them
  return images_;
}

unsigned CpuBlender::threads() {
  return std::max(1u, std::thread::hardware_concurrency());
}

}  // namespace surefield
