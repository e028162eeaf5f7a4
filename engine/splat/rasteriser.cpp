#include "engine/splat/rasteriser.h"

#include <Eigen/SVD>
#include <cmath>

namespace surefield {

namespace {

constexpr uint32_t kReduceWorkgroup = 64;

Eigen::Vector3d to_eigen(const glsl::vec3& v) {
  return {v.x, v.y, v.z};
}

passes::blend_forward::Constants forward_constants(const TileShape& s, Outputs outputs) {
  return {.TILE_W = s.width,
          .TILE_H = s.height,
          .LANES = s.lanes,
          .WITH_GEOMETRY = outputs == Outputs::ColourDepth ? 0u : 1u,
          .WITH_DOMINATORS = outputs == Outputs::All ? 1u : 0u};
}

}  // namespace

glsl::vec3 to_vec3(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

glsl::CameraState to_device(const Camera& camera) {
  const Eigen::Matrix3f R = camera.world_to_camera.rotation().cast<float>();
  const Intrinsics& k = camera.intrinsics;
  return {.rotation0 = to_vec3(R.row(0)),
          .rotation1 = to_vec3(R.row(1)),
          .rotation2 = to_vec3(R.row(2)),
          .translation = to_vec3(camera.world_to_camera.translation().cast<float>()),
          .fx = static_cast<float>(k.fx),
          .fy = static_cast<float>(k.fy),
          .cx = static_cast<float>(k.cx),
          .cy = static_cast<float>(k.cy),
          .width = static_cast<uint32_t>(k.width),
          .height = static_cast<uint32_t>(k.height)};
}

Pose pose_of(const glsl::CameraState& state) {
  Eigen::Matrix3d R;
  R.row(0) = to_eigen(state.rotation0);
  R.row(1) = to_eigen(state.rotation1);
  R.row(2) = to_eigen(state.rotation2);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Pose pose = Pose::Identity();
  pose.linear() = svd.matrixU() * svd.matrixV().transpose();
  pose.translation() = to_eigen(state.translation);
  return pose;
}

Rasteriser::Rasteriser(gpu::Device& device) : Rasteriser(device, TileShape::for_device(device)) {}

Rasteriser::Rasteriser(gpu::Device& device, const TileShape& shape)
    : lists(device, shape),
      colour_opacity(device, "colour and opacity image"),
      geometry(device, "geometry image"),
      dominators(device, "dominator image"),
      pixel_upstream(device, "pixel upstream"),
      gaussian_gradients(device, "Gaussian gradients"),
      sh_gradients(device, "SH gradients"),
      pose_gradient(device, "pose gradient"),
      device_(device),
      forward_(device, shape.lanes, forward_constants(shape, Outputs::ColourDepth)),
      forward_geometry_(device, shape.lanes, forward_constants(shape, Outputs::Geometry)),
      forward_all_(device, shape.lanes, forward_constants(shape, Outputs::All)),
      backward_(device, shape.lanes, {.TILE_W = shape.width, .TILE_H = shape.height, .LANES = shape.lanes}),
      reduce_pose_(device, kReduceWorkgroup),
      footprint_gradients_(device, "footprint gradients"),
      layer_gradients_(device, "layer gradients"),
      pose_partials_(device, "partial pose gradients"),
      render_camera_(device, "camera"),
      render_depth_(device, "sensor depth") {}

Rasteriser::BackwardPasses& Rasteriser::backward_passes(const GaussianMap& map, PoseGradientKind kind) {
  const bool full = kind == PoseGradientKind::Full;
  const bool plane = map.depth_model() == DepthModel::Plane;
  auto& made = backward_passes_[map.sh_degree()][full][plane];
  if (made) return *made;
  const TileShape& s = lists.shape();
  passes::blend_backward_pose::Constants constants{.TILE_W = s.width,
                                                   .TILE_H = s.height,
                                                   .LANES = s.lanes,
                                                   .SH_DEGREE = static_cast<uint32_t>(map.sh_degree()),
                                                   .FULL_POSE_GRADIENT = full ? 1u : 0u,
                                                   .WITH_GEOMETRY = 0,
                                                   .PLANE_DEPTH = plane ? 1u : 0u};
  auto all = constants;
  all.WITH_GEOMETRY = 1;
  made.reset(new BackwardPasses{{device_, s.lanes, constants},
                                {device_, s.lanes, all},
                                {device_,
                                 gpu::kWorkgroup,
                                 {.SH_DEGREE = constants.SH_DEGREE,
                                  .FULL_POSE_GRADIENT = constants.FULL_POSE_GRADIENT,
                                  .PLANE_DEPTH = constants.PLANE_DEPTH}}});
  return *made;
}

void Rasteriser::record_forward(gpu::Recorder& recorder, const GaussianMap& map, const View& view,
                                Outputs outputs) {
  recorder.reserve(pixel_upstream, view.size.pixels());
  if (view.same_lists)
    lists.record_again(recorder, map, view.camera, view.uncertainty_above);
  else
    lists.record(recorder, map, view.camera, view.size, view.uncertainty_above);
  record_blending(recorder, view, outputs);
}

void Rasteriser::record_blending(gpu::Recorder& recorder, const View& view, Outputs outputs) {
  recorder.reserve(colour_opacity, view.size.pixels());
  recorder.reserve(geometry, view.size.pixels());
  recorder.reserve(dominators, view.size.pixels());
  const auto& pass = outputs == Outputs::All        ? forward_all_
                     : outputs == Outputs::Geometry ? forward_geometry_
                                                    : forward_;
  recorder.dispatch(pass, lists.tiles_x(view.size), lists.tiles_y(view.size),
                    {.camera = view.camera,
                     .splats = lists.splats,
                     .tile_gaussians = lists.tile_gaussians,
                     .tile_ranges = lists.tile_ranges,
                     .sensor_depth = view.sensor_depth,
                     .colour_opacity = colour_opacity,
                     .geometry = geometry,
                     .dominators = dominators},
                    {.background = to_vec3(view.background)});
}

void Rasteriser::record_backward(gpu::Recorder& recorder, GaussianMap& map, const View& view,
                                 PoseGradientKind kind, const IsotropyTerm& isotropy) {
  const uint32_t subgroups = gpu::kWorkgroup / lists.shape().lanes;
  const uint64_t groups = map.size() / gpu::kWorkgroup + 1;
  recorder.reserve(footprint_gradients_, lists.instance_capacity());
  recorder.reserve(layer_gradients_, lists.instance_capacity());
  recorder.reserve(pose_partials_, groups * subgroups);
  recorder.reserve(gaussian_gradients, map.size());
  recorder.reserve(sh_gradients, map.size() * static_cast<uint64_t>(sh_coefficients(map.sh_degree())));
  // A tile that stops early does not reach all of its instances: their sums are zero.
  recorder.fill(footprint_gradients_, lists.instance_capacity(), 0);
  recorder.fill(layer_gradients_, lists.instance_capacity(), 0);
  recorder.dispatch(backward_, lists.tiles_x(view.size), lists.tiles_y(view.size),
                    {.camera = view.camera,
                     .splats = lists.splats,
                     .instances = lists.instances,
                     .tile_gaussians = lists.tile_gaussians,
                     .tile_ranges = lists.tile_ranges,
                     .sensor_depth = view.sensor_depth,
                     .pixel_upstream = pixel_upstream,
                     .footprint_gradients = footprint_gradients_,
                     .layer_gradients = layer_gradients_},
                    {});
  recorder.dispatch_indirect(backward_passes(map, kind).project, lists.dispatch_args, TileLists::kVisibleArgs,
                             {.camera = view.camera,
                              .means = map.means.value,
                              .log_scales = map.log_scales.value,
                              .rotations = map.rotations.value,
                              .sh = map.sh.value,
                              .splats = lists.splats,
                              .visible_count = lists.visible_count,
                              .visible_ids = lists.visible_ids,
                              .instance_offsets = lists.instance_offsets,
                              .tile_counts = lists.tile_counts,
                              .footprint_gradients = footprint_gradients_,
                              .layer_gradients = layer_gradients_,
                              .gaussian_gradients = gaussian_gradients,
                              .sh_gradients = sh_gradients,
                              .pose_partials = pose_partials_,
                              .status = lists.status,
                              .densification = map.densification,
                              .sampling = map.sampling},
                             {.weight_isotropy = isotropy.weight, .isotropy_epsilon = isotropy.epsilon});
  recorder.dispatch(
      reduce_pose_, 1,
      {.visible_count = lists.visible_count, .pose_partials = pose_partials_, .pose_gradient = pose_gradient},
      {.count = 0, .workgroup_size = gpu::kWorkgroup, .subgroups = subgroups});
}

void Rasteriser::record_backward_pose(gpu::Recorder& recorder, const GaussianMap& map, const View& view,
                                      PoseGradientKind kind, Outputs outputs) {
  const uint32_t tiles = lists.tiles_x(view.size) * lists.tiles_y(view.size);
  recorder.reserve(pose_partials_, tiles);
  BackwardPasses& made = backward_passes(map, kind);
  recorder.dispatch(outputs == Outputs::ColourDepth ? made.blend_pose : made.blend_pose_all,
                    lists.tiles_x(view.size), lists.tiles_y(view.size),
                    {.camera = view.camera,
                     .splats = lists.splats,
                     .tile_gaussians = lists.tile_gaussians,
                     .tile_ranges = lists.tile_ranges,
                     .sensor_depth = view.sensor_depth,
                     .pixel_upstream = pixel_upstream,
                     .means = map.means.value,
                     .log_scales = map.log_scales.value,
                     .rotations = map.rotations.value,
                     .sh = map.sh.value,
                     .pose_partials = pose_partials_,
                     .sampling = map.sampling},
                    {});
  recorder.dispatch(
      reduce_pose_, 1,
      {.visible_count = lists.visible_count, .pose_partials = pose_partials_, .pose_gradient = pose_gradient},
      {.count = tiles, .workgroup_size = 0, .subgroups = 0});
}

RenderImages Rasteriser::render(const GaussianMap& map, const Camera& camera,
                                std::span<const float> sensor_depth, const Eigen::Vector3f& background) {
  const ImageSize size{static_cast<uint32_t>(camera.intrinsics.width),
                       static_cast<uint32_t>(camera.intrinsics.height)};
  const glsl::CameraState host_state = to_device(camera);
  render_camera_.upload(std::span(&host_state, 1));
  std::vector<float> clean(sensor_depth.begin(), sensor_depth.end());
  clean.resize(size.pixels(), 0.0f);
  for (float& d : clean)
    if (!std::isfinite(d) || d < 0) d = 0;
  render_depth_.upload(clean);
  gpu::Recorder recorder(device_);
  const View view{
      .size = size, .camera = render_camera_, .sensor_depth = render_depth_, .background = background};
  lists.submit(recorder, 1, [&](std::size_t) { record_forward(recorder, map, view, Outputs::All); });

  RenderImages images;
  images.width = static_cast<int>(size.width);
  images.height = static_cast<int>(size.height);
  const auto geo = geometry.download(size.pixels());
  const auto ids = dominators.download(size.pixels());
  for (const glsl::vec4& p : colour_opacity.download(size.pixels())) {
    images.colour.insert(images.colour.end(), {p.x, p.y, p.z});
    images.opacity.push_back(p.w);
  }
  for (uint64_t i = 0; i < size.pixels(); ++i) {
    images.depth.push_back(geo[i].x);
    images.depth_normalised.push_back(images.opacity[i] > 0 ? geo[i].x / images.opacity[i] : 0.0f);
    images.depth_median.push_back(geo[i].y);
    images.uncertainty.push_back(geo[i].z);
    images.dominator_weight.push_back(geo[i].w);
    images.dominator.push_back(static_cast<int32_t>(ids[i]));
  }
  return images;
}

}  // namespace surefield
