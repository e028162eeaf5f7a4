#include "engine/synth/scene_renderer.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/synth/light_lists.h"
#include "engine/types/error.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

template <class V>
glsl::vec3 vec(const V& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

glsl::SceneShape to_device(const Shape& shape) {
  const Eigen::Matrix3d m = shape.to_unit();
  return {vec(shape.shape_to_world.translation()), vec(m.row(0)), vec(m.row(1)), vec(m.row(2)),
          static_cast<glsl::uint>(shape.kind)};
}

glsl::SceneSurface surface_of(const Shape& shape, glsl::uint index) {
  // Bodies of one wall share its texture.
  const bool continued = shape.texture_origin != shape.shape_to_world.translation();
  const glsl::uint own = shape.texture != 0 ? shape.texture : index + 1;
  return {vec(shape.half_size), vec(shape.texture_origin), static_cast<glsl::uint>(shape.material),
          continued ? 0 : own};
}

glsl::SceneMaterial to_device(const Material& m, glsl::uint index) {
  return {vec(m.first),
          vec(m.second),
          vec(m.noise_frequency),
          m.noise_contrast,
          m.noise_decay,
          {m.cell.x(), m.cell.y()},
          m.cell_shift,
          m.cell_contrast,
          m.cell_hue,
          m.joint,
          m.gloss,
          m.shininess,
          m.emission,
          static_cast<glsl::uint>(m.pattern),
          7919 * (index + 1)};
}

glsl::CastPose to_device(const Pose& world_to_camera) {
  const Pose to_world = world_to_camera.inverse();
  return {vec(to_world.translation()), vec(to_world.linear().col(0)), vec(to_world.linear().col(1)),
          vec(to_world.linear().col(2))};
}

/// How far the poses are from the first one of depth.
struct Motion {
  double metres = 0, radians = 0;
};

Motion motion_of(const Exposure& exposure) {
  Motion motion;
  const Pose& first = exposure.depth_poses.front();
  const Vector3d centre = first.inverse().translation();
  for (const auto* poses : {&exposure.depth_poses, &exposure.colour_poses}) {
    for (const Pose& pose : *poses) {
      motion.metres = std::max(motion.metres, (pose.inverse().translation() - centre).norm());
      const Eigen::Matrix3d turn = pose.linear() * first.linear().transpose();
      motion.radians = std::max(motion.radians, Eigen::AngleAxisd(turn).angle());
    }
  }
  return motion;
}

/// Never empty, as a buffer must not be.
template <class T>
std::vector<T> at_least_one(std::vector<T> values) {
  if (values.empty()) values.emplace_back();
  return values;
}

}  // namespace

static_assert(static_cast<uint32_t>(ShapeKind::Cylinder) == glsl::SHAPE_CYLINDER);
static_assert(static_cast<uint32_t>(Pattern::Screen) == glsl::PATTERN_SCREEN);

SceneRenderer::SceneRenderer(gpu::Device& device, const Scene& scene, bool with_visitor)
    : device_(device),
      pass_(device, glsl::CAST_TILE * glsl::CAST_TILE),
      surfaces_(device, "scene surfaces"),
      materials_(device, "scene materials"),
      lights_(device, "scene lights"),
      light_cells_(device, "light cells"),
      light_entries_(device, "light entries"),
      shapes_(device, "scene shapes"),
      poses_(device, "camera poses"),
      colour_(device, "cast colour"),
      hit_shapes_(device, "cast shapes"),
      depth_(device, "cast depth") {
  if (with_visitor) {
    visitor_ = scene.visitor.shapes;
    visitor_motion_ = scene.visitor;
  }
  still_shapes_ = static_cast<uint32_t>(scene.shapes.size());
  while (first_round_ < still_shapes_ && scene.shapes[first_round_].kind == ShapeKind::Box) ++first_round_;
  lights_count_ = static_cast<uint32_t>(scene.lights.size());
  if (still_shapes_ + visitor_.size() > glsl::SCENE_SHAPES) {
    throw InputError(fmt::format("scene {}: {} bodies, there is room for {}", scene.name, scene.shapes.size(),
                                 glsl::SCENE_SHAPES));
  }
  std::vector<glsl::SceneShape> shapes;
  std::vector<glsl::SceneSurface> surfaces;
  const auto add = [&](const Shape& shape) {
    surfaces.push_back(surface_of(shape, static_cast<glsl::uint>(surfaces.size())));
    shapes.push_back(surefield::to_device(shape));
  };
  for (const Shape& shape : scene.shapes) add(shape);
  for (const Shape& shape : visitor_) add(shape);
  std::vector<glsl::SceneMaterial> materials;
  for (const Material& m : scene.materials)
    materials.push_back(surefield::to_device(m, static_cast<glsl::uint>(materials.size())));
  std::vector<glsl::SceneLight> lights;
  for (const Light& light : scene.lights)
    lights.push_back({vec(light.position), vec(light.colour), static_cast<float>(light.range)});
  const LightLists lists = make_light_lists(scene);
  shapes_.upload(shapes);
  surfaces_.upload(surfaces);
  materials_.upload(materials);
  lights_.upload(at_least_one(lights));
  light_cells_.upload(at_least_one(lists.cells));
  light_entries_.upload(at_least_one(lists.entries));
}

void SceneRenderer::place_visitor(double seconds) const {
  if (visitor_.empty()) return;
  const Eigen::Isometry3d to_world = visitor_motion_.pose(seconds);
  std::vector<glsl::SceneShape> placed;
  for (Shape shape : visitor_) {
    shape.shape_to_world = to_world * shape.shape_to_world;
    placed.push_back(surefield::to_device(shape));
  }
  shapes_.upload(placed, still_shapes_);
}

SceneImages SceneRenderer::render(const Camera& camera) const {
  Exposure exposure;
  exposure.intrinsics = camera.intrinsics;
  exposure.depth_poses = {camera.world_to_camera};
  exposure.colour_poses = {camera.world_to_camera};
  return render(exposure);
}

SceneImages SceneRenderer::render(const Exposure& exposure) const {
  const Intrinsics& k = exposure.intrinsics;
  const auto width = static_cast<uint32_t>(k.width), height = static_cast<uint32_t>(k.height);
  const Motion motion = motion_of(exposure);
  std::vector<glsl::CastPose> poses;
  for (const auto* of_image : {&exposure.depth_poses, &exposure.colour_poses})
    for (const Pose& pose : *of_image) poses.push_back(surefield::to_device(pose));

  const std::lock_guard lock(mutex_);
  place_visitor(exposure.visitor_seconds);
  poses_.upload(poses);
  const uint64_t pixels = uint64_t{width} * height;
  colour_.reserve(pixels);
  hit_shapes_.reserve(pixels);
  depth_.reserve(pixels);
  gpu::Recorder recorder(device_);
  recorder.dispatch(pass_, (width + glsl::CAST_TILE - 1) / glsl::CAST_TILE,
                    (height + glsl::CAST_TILE - 1) / glsl::CAST_TILE,
                    {.poses = poses_,
                     .shapes = shapes_,
                     .surfaces = surfaces_,
                     .materials = materials_,
                     .lights = lights_,
                     .light_cells = light_cells_,
                     .light_entries = light_entries_,
                     .colour = colour_,
                     .depth = depth_,
                     .hit_shapes = hit_shapes_},
                    {.width = width,
                     .height = height,
                     .fx = static_cast<float>(k.fx),
                     .fy = static_cast<float>(k.fy),
                     .cx = static_cast<float>(k.cx),
                     .cy = static_cast<float>(k.cy),
                     .shapes = still_shapes_ + static_cast<uint32_t>(visitor_.size()),
                     .first_round = first_round_,
                     .first_moving = still_shapes_,
                     .lights = lights_count_,
                     .samples = static_cast<uint32_t>(exposure.samples),
                     .depth_poses = static_cast<uint32_t>(exposure.depth_poses.size()),
                     .colour_poses = static_cast<uint32_t>(exposure.colour_poses.size()),
                     .readout = static_cast<float>(exposure.readout),
                     .exposure = static_cast<float>(exposure.exposure),
                     .wander = static_cast<float>(1.001 * motion.metres),
                     .swing = static_cast<float>(1.001 * motion.radians),
                     .brightness = static_cast<float>(exposure.brightness),
                     .seed = exposure.seed});
  recorder.submit();

  SceneImages images;
  const auto colour = colour_.download(pixels);
  const auto depth = depth_.download(pixels);
  const auto shapes = hit_shapes_.download(pixels);
  images.colour.create(k.height, k.width, CV_8UC3);
  images.depth = cv::Mat(k.height, k.width, CV_32FC1, const_cast<float*>(depth.data())).clone();
  images.shapes = cv::Mat(k.height, k.width, CV_32SC1, const_cast<glsl::uint*>(shapes.data())).clone();
  auto* rgb = images.colour.ptr<uchar>();
  for (const glsl::uint packed : colour) {
    *rgb++ = static_cast<uchar>(packed & 255);
    *rgb++ = static_cast<uchar>((packed >> 8) & 255);
    *rgb++ = static_cast<uchar>((packed >> 16) & 255);
  }
  return images;
}

}  // namespace surefield
