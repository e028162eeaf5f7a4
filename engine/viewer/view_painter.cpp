#include "engine/viewer/view_painter.h"
#include "engine/types/error.h"

#include <opencv2/imgproc.hpp>
#include <string>

#include "engine/viewer/legend.h"

namespace surefield {

namespace {

/// What tells the passes of one mode from those of another.
struct Recipe {
  glsl::uint shade;
  std::optional<glsl::uint> prepare;  ///< none: splats keep their colour
};

Recipe recipe_of(ViewMode mode) {
  switch (mode) {
    case ViewMode::Depth:
      return {glsl::SHADE_DEPTH, {}};
    case ViewMode::MedianDepth:
      return {glsl::SHADE_MEDIAN_DEPTH, {}};
    case ViewMode::Opacity:
      return {glsl::SHADE_OPACITY, {}};
    case ViewMode::Uncertainty:
      return {glsl::SHADE_UNCERTAINTY, {}};
    case ViewMode::GaussianUncertainty:
      return {glsl::SHADE_GAUSSIAN_UNCERTAINTY, glsl::PREPARE_UNCERTAINTY};
    case ViewMode::Ellipsoids:
    case ViewMode::Points:
      return {glsl::SHADE_COLOUR, glsl::PREPARE_SOLID};
    case ViewMode::Normals:
      return {glsl::SHADE_COLOUR, glsl::PREPARE_NORMAL};
    case ViewMode::Sensor:
      return {glsl::SHADE_SENSOR, {}};
    case ViewMode::Error:
      return {glsl::SHADE_ERROR, {}};
    case ViewMode::Colour:
      break;
  }
  return {glsl::SHADE_COLOUR, {}};
}

bool is_solid(ViewMode mode) {
  return mode == ViewMode::Ellipsoids || mode == ViewMode::Points;
}

/// The mode's colours; where it paints no values, none that anybody sees.
std::vector<glsl::uint> palette_for(ViewMode mode) {
  std::vector<glsl::uint> palette = palette_of(mode);
  palette.resize(kPaletteSize);
  return palette;
}

}  // namespace

ViewPainter::ViewPainter(gpu::Device& device)
    : device_(device),
      map_(device),
      rasteriser_(device),
      overlay_(device),
      sensor_(device),
      modes_(view_modes().size()),
      resample_(device, gpu::kWorkgroup),
      camera_(device, "view camera"),
      sensor_colour_(device, "sensor colour of the view"),
      sensor_depth_(device, "sensor depth of the view"),
      reliefs_(device, "reliefs"),
      pixels_(device, "picture") {}

ViewPainter::ModePasses& ViewPainter::passes_of(ViewMode mode) {
  auto& made = modes_[static_cast<std::size_t>(mode)];
  if (made) return *made;
  const Recipe recipe = recipe_of(mode);
  const TileShape& s = rasteriser_.lists.shape();
  made.reset(new ModePasses{nullptr,
                            nullptr,
                            {device_, gpu::kWorkgroup, {.SHADE = recipe.shade}},
                            {device_, "palette", kPaletteSize}});
  made->palette.upload(palette_for(mode));
  if (recipe.prepare)
    made->prepare = std::make_unique<gpu::Pass<passes::colour_splats>>(
        device_, gpu::kWorkgroup, passes::colour_splats::Constants{.PREPARE = *recipe.prepare});
  if (is_solid(mode))
    made->solids = std::make_unique<gpu::Pass<passes::draw_solids>>(
        device_, s.lanes,
        passes::draw_solids::Constants{.TILE_W = s.width,
                                       .TILE_H = s.height,
                                       .LANES = s.lanes,
                                       .DOTS = mode == ViewMode::Points ? 1u : 0u});
  return *made;
}

void ViewPainter::assign(const GaussianCloud& cloud, DepthModel depth_model) {
  map_.assign(cloud, depth_model);
}

void ViewPainter::set_sensor(const FrameView& images, const Intrinsics& intrinsics) {
  sensor_.assign(images);
  sensor_intrinsics_ = intrinsics;
}

void ViewPainter::paint(const Camera& camera, const ViewSettings& settings, std::span<const Line> lines) {
  const ViewModeInfo& info = info_of(settings.mode);
  if (info.needs_sensor && sensor_.size.pixels() == 0)
    throw UsageError(std::string("the view mode ") + info.name + " needs a frame of the sensor");
  const glsl::CameraState state = to_device(camera);
  size_ = {state.width, state.height};
  camera_.upload(std::span(&state, 1));
  gpu::Recorder recorder(device_);
  rasteriser_.lists.submit(recorder, 1, [&](std::size_t) {
    record_picture(recorder, camera, settings);
    overlay_.record(recorder, lines, camera, rasteriser_, pixels_);
  });
}

void ViewPainter::record_sensor(gpu::Recorder& recorder, const Camera& camera) {
  recorder.reserve(sensor_colour_, size_.pixels());
  recorder.reserve(sensor_depth_, size_.pixels());
  if (sensor_.size.pixels() == 0) {
    recorder.fill(sensor_colour_, size_.pixels(), 0);
    recorder.fill(sensor_depth_, size_.pixels(), 0);
    return;
  }
  const Intrinsics &from = camera.intrinsics, &to = sensor_intrinsics_;
  const Eigen::Vector2d scale(to.fx / from.fx, to.fy / from.fy);
  const Eigen::Vector2d offset(to.cx - scale.x() * from.cx, to.cy - scale.y() * from.cy);
  recorder.dispatch(resample_, resample_.groups(size_.pixels()),
                    {.sensor_colour = sensor_.colour,
                     .sensor_depth = sensor_.depth,
                     .colour = sensor_colour_,
                     .depth = sensor_depth_},
                    {.size = {size_.width, size_.height},
                     .sensor_size = {sensor_.size.width, sensor_.size.height},
                     .scale = {static_cast<float>(scale.x()), static_cast<float>(scale.y())},
                     .offset = {static_cast<float>(offset.x()), static_cast<float>(offset.y())}});
}

void ViewPainter::record_solids(gpu::Recorder& recorder, const ModePasses& passes) {
  const TileLists& lists = rasteriser_.lists;
  recorder.reserve(rasteriser_.colour_opacity, size_.pixels());
  recorder.reserve(rasteriser_.geometry, size_.pixels());
  recorder.dispatch(*passes.solids, lists.tiles_x(size_), lists.tiles_y(size_),
                    {.camera = camera_,
                     .splats = lists.splats,
                     .reliefs = reliefs_,
                     .tile_gaussians = lists.tile_gaussians,
                     .tile_ranges = lists.tile_ranges,
                     .colour_opacity = rasteriser_.colour_opacity,
                     .geometry = rasteriser_.geometry},
                    {});
}

void ViewPainter::record_picture(gpu::Recorder& recorder, const Camera& camera,
                                 const ViewSettings& settings) {
  const ModePasses& passes = passes_of(settings.mode);
  TileLists& lists = rasteriser_.lists;
  recorder.reserve(reliefs_, map_.size());
  recorder.reserve(pixels_, size_.pixels());
  record_sensor(recorder, camera);
  lists.record(recorder, map_, camera_, size_, std::numeric_limits<float>::infinity());
  if (passes.prepare)
    recorder.dispatch_indirect(*passes.prepare, lists.dispatch_args, TileLists::kVisibleArgs,
                               {.camera = camera_,
                                .means = map_.means.value,
                                .log_scales = map_.log_scales.value,
                                .rotations = map_.rotations.value,
                                .uncertainty = map_.uncertainty,
                                .visible_count = lists.visible_count,
                                .visible_ids = lists.visible_ids,
                                .splats = lists.splats,
                                .reliefs = reliefs_},
                               {});
  if (passes.solids)
    record_solids(recorder, passes);
  else
    rasteriser_.record_blending(recorder, {size_, camera_, sensor_depth_}, Outputs::All);
  const auto [low, high] = scale_of(settings);
  recorder.dispatch(passes.shade, passes.shade.groups(size_.pixels()),
                    {.colour_opacity = rasteriser_.colour_opacity,
                     .geometry = rasteriser_.geometry,
                     .sensor_colour = sensor_colour_,
                     .sensor_depth = sensor_depth_,
                     .palette = passes.palette,
                     .picture = pixels_},
                    {.pixels = static_cast<uint32_t>(size_.pixels()),
                     .low = low,
                     .high = high,
                     .background = to_vec3(settings.background),
                     .width = size_.width,
                     .checker = settings.checker});
}

cv::Mat ViewPainter::picture() const {
  std::vector<glsl::uint> pixels = pixels_.download(size_.pixels());
  const cv::Mat rgba(static_cast<int>(size_.height), static_cast<int>(size_.width), CV_8UC4, pixels.data());
  cv::Mat rgb;
  cv::cvtColor(rgba, rgb, cv::COLOR_RGBA2RGB);
  return rgb;
}

}  // namespace surefield
