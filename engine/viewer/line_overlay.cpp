#include "engine/viewer/line_overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace surefield {

namespace {

constexpr float kNearest = 0.01f;      // metres; lines are cut where they come nearer to the camera
constexpr float kAlwaysNearer = 1e9f;  // inverse depth of lines that nothing hides
constexpr float kHidden = 0.2f;        // of the opacity of a line behind the map

glsl::uint pack(const Eigen::Vector4f& colour) {
  glsl::uint packed = 0;
  for (int i = 0; i < 4; ++i) {
    const float level = std::clamp(colour[i], 0.0f, 1.0f) * 255;
    packed |= static_cast<glsl::uint>(std::lround(level)) << (8 * i);
  }
  return packed;
}

/// Narrows [begin, end], a part of the way from `a` to `b`, to where the value between them is at least
/// `least`.
void cut(float a, float b, float least, float& begin, float& end) {
  if (a < least && b < least) end = begin - 1;
  if (a < least && b >= least) begin = std::max(begin, (least - a) / (b - a));
  if (b < least && a >= least) end = std::min(end, (least - a) / (b - a));
}

/// The part of the way between two places of the image that is inside it, with a margin.
bool clip_to_image(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Intrinsics& k, float margin,
                   float& begin, float& end) {
  begin = 0;
  end = 1;
  cut(a.x(), b.x(), -margin, begin, end);
  cut(-a.x(), -b.x(), -margin - static_cast<float>(k.width - 1), begin, end);
  cut(a.y(), b.y(), -margin, begin, end);
  cut(-a.y(), -b.y(), -margin - static_cast<float>(k.height - 1), begin, end);
  return begin <= end;
}

Eigen::Vector2f pixel_of(const Eigen::Vector3f& p, const Intrinsics& k) {
  const Eigen::Vector3d d = p.cast<double>();
  return Eigen::Vector2d(k.fx * d.x() / d.z() + k.cx, k.fy * d.y() / d.z() + k.cy).cast<float>();
}

/// Distance of a point from the part of a line between two points.
float distance_to(const Eigen::Vector2f& p, const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  const Eigen::Vector2f along = b - a;
  const float t = std::clamp((p - a).dot(along) / std::max(along.squaredNorm(), 1e-12f), 0.0f, 1.0f);
  return (p - a - t * along).norm();
}

/// The first and last tile on one axis that a line between `a` and `b` may touch.
std::pair<int, int> tile_span(float a, float b, float reach, uint32_t pixels) {
  constexpr float kSide = glsl::LINE_TILE;
  const int last = static_cast<int>((pixels - 1) / glsl::LINE_TILE);
  return {std::max(static_cast<int>(std::floor((std::min(a, b) - reach) / kSide)), 0),
          std::min(static_cast<int>(std::floor((std::max(a, b) + reach) / kSide)), last)};
}

}  // namespace

std::vector<glsl::LineSegment> project_lines(std::span<const Line> lines, const Camera& camera) {
  std::vector<glsl::LineSegment> segments;
  const Intrinsics& k = camera.intrinsics;
  const Eigen::Isometry3f pose = camera.world_to_camera.cast<float>();
  for (const Line& line : lines) {
    const Eigen::Vector3f from = pose * line.from, to = pose * line.to;
    float begin = 0, end = 1;
    cut(from.z(), to.z(), kNearest, begin, end);
    if (!(begin <= end) || !from.allFinite() || !to.allFinite()) continue;
    const Eigen::Vector3f near_from = from + begin * (to - from), near_to = from + end * (to - from);
    const Eigen::Vector2f a = pixel_of(near_from, k), b = pixel_of(near_to, k);
    if (!clip_to_image(a, b, k, line.width + 1, begin, end)) continue;
    const Eigen::Vector2f p = a + begin * (b - a), q = a + end * (b - a);
    // 1 / z is linear along the line on the image.
    const auto inverse_depth = [&](float t) {
      return line.on_top ? kAlwaysNearer : (1 - t) / near_from.z() + t / near_to.z();
    };
    segments.push_back({.from = {p.x(), p.y()},
                        .to = {q.x(), q.y()},
                        .inverse_depth_from = inverse_depth(begin),
                        .inverse_depth_to = inverse_depth(end),
                        .half_width = line.width / 2,
                        .colour = pack(line.colour)});
  }
  return segments;
}

LineBins bin_lines(std::span<const glsl::LineSegment> segments, const ImageSize& size) {
  struct Entry {
    uint32_t y, x, segment;
    bool operator<(const Entry& o) const { return std::tie(y, x, segment) < std::tie(o.y, o.x, o.segment); }
  };
  constexpr float kSide = glsl::LINE_TILE;
  const float half_diagonal = (kSide - 1) * 0.7072f;  // of the centres of a tile's pixels
  std::vector<Entry> entries;
  for (uint32_t i = 0; i < segments.size(); ++i) {
    const glsl::LineSegment& s = segments[i];
    const Eigen::Vector2f a(s.from.x, s.from.y), b(s.to.x, s.to.y);
    const float reach = s.half_width + 0.5f;
    const auto columns = tile_span(a.x(), b.x(), reach, size.width);
    const auto rows = tile_span(a.y(), b.y(), reach, size.height);
    for (int y = rows.first; y <= rows.second; ++y)
      for (int x = columns.first; x <= columns.second; ++x) {
        const Eigen::Vector2f middle = kSide * Eigen::Vector2f(x, y).array() + (kSide - 1) / 2;
        if (distance_to(middle, a, b) <= half_diagonal + reach)
          entries.push_back({static_cast<uint32_t>(y), static_cast<uint32_t>(x), i});
      }
  }
  std::sort(entries.begin(), entries.end());
  LineBins bins;
  for (const Entry& entry : entries) {
    const auto place = static_cast<uint32_t>(bins.segments.size());
    if (bins.tiles.empty() || bins.tiles.back().x != entry.x || bins.tiles.back().y != entry.y)
      bins.tiles.push_back({.x = entry.x, .y = entry.y, .begin = place, .end = place});
    bins.segments.push_back(entry.segment);
    ++bins.tiles.back().end;
  }
  return bins;
}

LineOverlay::LineOverlay(gpu::Device& device)
    : draw_(device, glsl::LINE_TILE * glsl::LINE_TILE),
      segments_(device, "line segments"),
      tiles_(device, "tiles with lines"),
      tile_segments_(device, "lines of tiles") {}

void LineOverlay::record(gpu::Recorder& recorder, std::span<const Line> lines, const Camera& camera,
                         const Rasteriser& rasteriser, const gpu::Array<glsl::uint>& picture) {
  const ImageSize size{static_cast<uint32_t>(camera.intrinsics.width),
                       static_cast<uint32_t>(camera.intrinsics.height)};
  const auto segments = project_lines(lines, camera);
  const LineBins bins = bin_lines(segments, size);
  if (bins.tiles.empty()) return;
  segments_.upload(segments);
  tiles_.upload(bins.tiles);
  tile_segments_.upload(bins.segments);
  recorder.dispatch(draw_, static_cast<uint32_t>(bins.tiles.size()),
                    {.segments = segments_,
                     .line_tiles = tiles_,
                     .tile_segments = tile_segments_,
                     .colour_opacity = rasteriser.colour_opacity,
                     .geometry = rasteriser.geometry,
                     .picture = picture},
                    {.size = {size.width, size.height}, .hidden = kHidden});
}

}  // namespace surefield
