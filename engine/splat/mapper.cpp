#include "engine/splat/mapper.h"

namespace surefield {

namespace {

uint32_t strips(uint32_t length) {
  return (length + glsl::SSIM_STRIP - 1) / glsl::SSIM_STRIP;
}

}  // namespace

CameraVariable::CameraVariable(gpu::Device& device, const Camera& initial, const Eigen::Vector3f& view_gains)
    : camera(device, "keyframe camera"), adam(device, "keyframe Adam") {
  assign(initial, view_gains);
}

void CameraVariable::assign(const Camera& initial, const Eigen::Vector3f& view_gains) {
  gains = to_vec3(view_gains);
  const glsl::CameraState state = to_device(initial);
  camera.upload(std::span(&state, 1));
  adam.upload(std::vector<glsl::PoseAdam>{{}});
}

Mapper::Mapper(gpu::Device& device)
    : loss(device, "mapping loss"),
      device_(device),
      ssim_rows_(device, gpu::kWorkgroup),
      ssim_columns_(device, gpu::kWorkgroup),
      ssim_slope_rows_(device, gpu::kWorkgroup),
      gradient_alpha_(device, gpu::kWorkgroup, {.NORMALISED_DEPTH = 0}),
      gradient_normalised_(device, gpu::kWorkgroup, {.NORMALISED_DEPTH = 1}),
      sum_losses_(device, gpu::kWorkgroup),
      update_(device, gpu::kWorkgroup),
      refine_pose_(device, device.limits().subgroup_size),
      moments_(device, "SSIM moments"),
      slopes_(device, "SSIM slopes"),
      row_slopes_(device, "SSIM row slopes"),
      ssim_partials_(device, "SSIM partial sums"),
      loss_partials_(device, "mapping partial sums"),
      median_count_(device, "median count") {}

gpu::Pass<passes::update_colours>& Mapper::colour_update(int sh_degree) {
  auto& pass = update_colours_[sh_degree];
  if (!pass)
    pass = std::make_unique<gpu::Pass<passes::update_colours>>(
        device_, gpu::kWorkgroup, passes::update_colours::Constants{static_cast<uint32_t>(sh_degree)});
  return *pass;
}

void Mapper::record_ssim(gpu::Recorder& recorder, const Rasteriser& rasteriser, const SensorFrame& frame,
                         const glsl::vec3& gains) {
  const auto [width, height] = frame.size;
  const uint32_t row_strips = strips(width) * height, column_strips = strips(height) * width;
  recorder.reserve(moments_, frame.size.pixels());
  recorder.reserve(slopes_, frame.size.pixels());
  recorder.reserve(row_slopes_, frame.size.pixels());
  recorder.reserve(ssim_partials_, column_strips);
  recorder.fill(median_count_, 1, 0);
  recorder.dispatch(ssim_rows_, ssim_rows_.groups(row_strips),
                    {.colour_opacity = rasteriser.colour_opacity,
                     .sensor_colour = frame.colour,
                     .geometry = rasteriser.geometry,
                     .moments = moments_,
                     .median_count = median_count_,
                     .sensor_depth = frame.depth},
                    {.width = width, .height = height, .gains = gains});
  recorder.dispatch(
      ssim_columns_, ssim_columns_.groups(column_strips),
      {.moments = moments_, .slopes = slopes_, .ssim_partials = ssim_partials_, .sensor_depth = frame.depth},
      {.width = width, .height = height});
  recorder.dispatch(ssim_slope_rows_, ssim_slope_rows_.groups(row_strips),
                    {.slopes = slopes_, .row_slopes = row_slopes_}, {.width = width, .height = height});
}

void Mapper::record_loss(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map,
                         const SensorFrame& frame, const CameraVariable& camera,
                         const MappingSettings& settings, bool same_lists) {
  View view{frame.size, camera.camera, frame.depth};
  view.same_lists = same_lists;
  rasteriser.record_forward(recorder, map, view, Outputs::Geometry);
  record_ssim(recorder, rasteriser, frame, camera.gains);
  const auto [width, height] = frame.size;
  const uint32_t column_strips = strips(height) * width;
  recorder.reserve(loss_partials_, column_strips);
  auto& gradient = settings.depth == DepthKind::Normalised ? gradient_normalised_ : gradient_alpha_;
  recorder.dispatch(gradient, gradient.groups(column_strips),
                    {.colour_opacity = rasteriser.colour_opacity,
                     .geometry = rasteriser.geometry,
                     .sensor_colour = frame.colour,
                     .sensor_depth = frame.depth,
                     .row_slopes = row_slopes_,
                     .median_count = median_count_,
                     .ssim_partials = ssim_partials_,
                     .pixel_upstream = rasteriser.pixel_upstream,
                     .loss_partials = loss_partials_},
                    {.width = width,
                     .height = height,
                     .valid_pixels = static_cast<float>(frame.valid_pixels),
                     .w_colour = static_cast<float>(settings.weight_colour),
                     .w_ssim = static_cast<float>(settings.weight_ssim),
                     .w_depth = static_cast<float>(settings.weight_depth),
                     .w_align = static_cast<float>(settings.weight_align),
                     .w_variance = static_cast<float>(settings.weight_variance),
                     .background = to_vec3(view.background),
                     .gains = camera.gains});
  recorder.dispatch(sum_losses_, 1, {.loss_partials = loss_partials_, .loss = loss},
                    {.count = column_strips});
}

void Mapper::record_update(gpu::Recorder& recorder, const Rasteriser& rasteriser, GaussianMap& map,
                           const MappingSettings& settings, double pixel) {
  const TileLists& lists = rasteriser.lists;
  recorder.dispatch_indirect(update_, lists.dispatch_args, TileLists::kVisibleArgs,
                             {.status = lists.status,
                              .visible_count = lists.visible_count,
                              .visible_ids = lists.visible_ids,
                              .gaussian_gradients = rasteriser.gaussian_gradients,
                              .means = map.means.value,
                              .means_m = map.means.first_moment,
                              .means_v = map.means.second_moment,
                              .log_scales = map.log_scales.value,
                              .log_scales_m = map.log_scales.first_moment,
                              .log_scales_v = map.log_scales.second_moment,
                              .rotations = map.rotations.value,
                              .rotations_m = map.rotations.first_moment,
                              .rotations_v = map.rotations.second_moment,
                              .opacity_logits = map.opacity_logits.value,
                              .opacity_logits_m = map.opacity_logits.first_moment,
                              .opacity_logits_v = map.opacity_logits.second_moment,
                              .steps = map.steps},
                             {.rate_mean = static_cast<float>(settings.rate_centre * pixel),
                              .rate_log_scale = static_cast<float>(settings.rate_size),
                              .rate_rotation = static_cast<float>(settings.rate_rotation),
                              .rate_opacity = static_cast<float>(settings.rate_opacity)});
  recorder.dispatch_indirect(colour_update(map.sh_degree()), lists.dispatch_args, TileLists::kVisibleArgs,
                             {.status = lists.status,
                              .visible_count = lists.visible_count,
                              .visible_ids = lists.visible_ids,
                              .sh_gradients = rasteriser.sh_gradients,
                              .steps = map.steps,
                              .sh = map.sh.value,
                              .sh_m = map.sh.first_moment,
                              .sh_v = map.sh.second_moment},
                             {.rate_base = static_cast<float>(settings.rate_colour),
                              .rate_rest = static_cast<float>(settings.rate_colour / 20)});
}

void Mapper::record_step(gpu::Recorder& recorder, Rasteriser& rasteriser, GaussianMap& map,
                         const MappingStep& step, const MappingSettings& settings, double pixel) {
  const auto& [frame, camera, refine_pose, same_lists] = step;
  record_loss(recorder, rasteriser, map, frame, camera, settings, same_lists);
  rasteriser.record_backward(recorder, map, {frame.size, camera.camera, frame.depth}, settings.pose_gradient,
                             {.weight = static_cast<float>(settings.weight_isotropy),
                              .epsilon = static_cast<float>(settings.isotropy_epsilon)});
  record_update(recorder, rasteriser, map, settings, pixel);
  if (!refine_pose) return;
  recorder.dispatch(refine_pose_, 1,
                    {.status = rasteriser.lists.status,
                     .pose_gradient = rasteriser.pose_gradient,
                     .camera = camera.camera,
                     .adam = camera.adam},
                    {.rate_rotation = static_cast<float>(settings.rate_pose_rotation),
                     .rate_translation = static_cast<float>(settings.rate_pose_translation)});
}

double Mapper::read_loss(const SensorFrame& frame, const MappingSettings& settings) const {
  const glsl::LossSums s = loss.download(1)[0];
  const double valid = std::max(1u, frame.valid_pixels), medians = std::max(1.0f, s.medians);
  const double channels = 3 * valid, dissimilarity = frame.valid_pixels > 0 ? 1 - s.ssim / valid : 0;
  return settings.weight_colour * s.colour / channels + settings.weight_ssim * dissimilarity +
         settings.weight_depth * s.depth / valid + settings.weight_align * s.align / medians +
         settings.weight_variance * s.variance / valid;
}

}  // namespace surefield
