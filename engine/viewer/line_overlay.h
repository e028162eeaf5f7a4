#pragma once

#include <vector>

#include "engine/splat/rasteriser.h"
#include "shaders/shared/draw_lines.h"

namespace surefield {

/// A line in the world to draw over a picture.
struct Line {
  Eigen::Vector3f from = Eigen::Vector3f::Zero();  ///< metres
  Eigen::Vector3f to = Eigen::Vector3f::Zero();
  Eigen::Vector4f colour = Eigen::Vector4f::Ones();  ///< RGB and opacity, 0 to 1
  float width = 2;                                   ///< pixels
  bool on_top = false;  ///< never behind the map; else the part behind it is faint
};

/// The lines as they lie on a camera's image, without what is behind the camera or beside the image.
std::vector<glsl::LineSegment> project_lines(std::span<const Line> lines, const Camera& camera);

/// For every tile of the image that lines may touch: which, in the order of `segments`.
struct LineBins {
  std::vector<glsl::LineTile> tiles;
  std::vector<glsl::uint> segments;
};
LineBins bin_lines(std::span<const glsl::LineSegment> segments, const ImageSize& size);

/// Draws lines over a picture on the device.
class LineOverlay {
 public:
  explicit LineOverlay(gpu::Device& device);

  /// Draws lines over `picture` (RGBA bytes), which shows what the rasteriser rendered last. They are blended
  /// in their order; a submission has at most one such call.
  void record(gpu::Recorder& recorder, std::span<const Line> lines, const Camera& camera,
              const Rasteriser& rasteriser, const gpu::Array<glsl::uint>& picture);

 private:
  gpu::Pass<passes::draw_lines> draw_;
  gpu::Array<glsl::LineSegment> segments_;
  gpu::Array<glsl::LineTile> tiles_;
  gpu::Array<glsl::uint> tile_segments_;
};

}  // namespace surefield
