#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "engine/splat/sensor_frame.h"
#include "engine/viewer/line_overlay.h"
#include "engine/viewer/view_mode.h"
#include "shaders/shared/colour_splats.h"
#include "shaders/shared/draw_solids.h"
#include "shaders/shared/resample_sensor.h"
#include "shaders/shared/shade_view.h"

namespace surefield {

/// What a picture shows, and on which scales.
struct ViewSettings {
  ViewMode mode = ViewMode::Colour;
  Eigen::Vector3f background{0.16f, 0.16f, 0.17f};  ///< RGB, 0 to 1
  uint32_t checker = 12;  ///< side of the squares of two tones that it is made of, pixels; 0: one tone
  float depth_near = 0;   ///< metres; the ends of the scale of depths
  float depth_far = 5;
  float error_far = 0.2f;  ///< metres; the end of the scale of uncertainties

  bool operator==(const ViewSettings&) const = default;
};

/// Paints pictures of a map from any camera: for a window, which takes them on the device, and for files. The
/// map is the painter's own copy, so that pictures may be painted while SLAM goes on with its own, on another
/// thread. Everything is splatted by the engine's own rasteriser. Not thread-safe.
///
///   gpu::Device device;
///   ViewPainter painter(device);
///   painter.assign(slam.map());
///   painter.paint(camera, {.mode = ViewMode::Depth}, lines);
///   write_png("depth.png", painter.picture());
class ViewPainter {
 public:
  explicit ViewPainter(gpu::Device& device);

  /// Replaces the map; as SplatEngine::assign().
  void assign(const GaussianCloud& cloud, DepthModel depth_model = DepthModel::Plane);
  uint32_t gaussians() const { return map_.size(); }

  /// Sets the frame that modes with `needs_sensor` compare the map with.
  void set_sensor(const FrameView& images, const Intrinsics& intrinsics);

  /// Paints what `camera` sees, with `lines` over it. In modes with `needs_sensor`, the camera's pose must be
  /// that of the frame; its intrinsics may be others. Throws UsageError where there is no frame.
  void paint(const Camera& camera, const ViewSettings& settings, std::span<const Line> lines = {});

  /// What the map has at every pixel of a view, in host memory, for pick(). The last picture stays.
  RenderImages measure(const Camera& camera) { return rasteriser_.render(map_, camera); }

  /// The last picture: RGBA bytes, row-major, on the device; and in host memory, CV_8UC3, RGB.
  const gpu::Array<glsl::uint>& pixels() const { return pixels_; }
  const ImageSize& size() const { return size_; }
  cv::Mat picture() const;

 private:
  struct ModePasses;
  ModePasses& passes_of(ViewMode mode);
  void record_sensor(gpu::Recorder& recorder, const Camera& camera);
  void record_solids(gpu::Recorder& recorder, const ModePasses& passes);
  void record_picture(gpu::Recorder& recorder, const Camera& camera, const ViewSettings& settings);

  gpu::Device& device_;
  GaussianMap map_;
  Rasteriser rasteriser_;
  LineOverlay overlay_;
  SensorFrame sensor_;
  Intrinsics sensor_intrinsics_;
  ImageSize size_;

  struct ModePasses {
    std::unique_ptr<gpu::Pass<passes::colour_splats>> prepare;  ///< none: splats keep their colour
    std::unique_ptr<gpu::Pass<passes::draw_solids>> solids;     ///< none: splats are blended
    gpu::Pass<passes::shade_view> shade;
    gpu::Array<glsl::uint> palette;  ///< 256 RGBA
  };
  std::vector<std::unique_ptr<ModePasses>> modes_;  ///< made when first needed
  gpu::Pass<passes::resample_sensor> resample_;

  gpu::Array<glsl::CameraState> camera_;
  gpu::Array<glsl::uint> sensor_colour_;  ///< at the pixels of the view, as the next
  gpu::Array<float> sensor_depth_;
  gpu::Array<float> reliefs_;
  gpu::Array<glsl::uint> pixels_;
};

}  // namespace surefield
