#include "tools/bench_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/io/error.h"
#include "engine/io/files.h"
#include "engine/io/json_file.h"
#include "engine/io/ply.h"
#include "engine/synth/room.h"

namespace surefield {

namespace {

constexpr double kFocalPerWidth = 0.85;  // a horizontal field of view of about 61 degrees
constexpr double kSecondsAround = 2;     // the map's views: so long before and after the camera's
constexpr int kViews = 9;
constexpr double kVisibleFraction = 0.65;  // of such a map's Gaussians lie in the camera's view

struct SceneSize {
  const char* name;
  int gaussians, width, height;
};
constexpr SceneSize kScenes[] = {
    {"small", 20'000, 160, 120}, {"medium", 50'000, 320, 240}, {"large", 150'000, 640, 480}};

/// Reproducible with every standard library, unlike the distributions of <random>.
class Random {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * 0x1p-32 * static_cast<double>(generator_());
  }

 private:
  std::mt19937 generator_{1};
};

/// World direction through a pixel, with camera z = 1: the distance along it is the depth.
Eigen::Vector3d ray(const Intrinsics& k, const Pose& to_world, double u, double v) {
  return to_world.linear() * Eigen::Vector3d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
}

/// Puts Gaussian `i` where the ray of `pixel` in the view `to_world` meets the room; `spacing` in pixels.
void place(const SyntheticRoom& room, const Intrinsics& k, const Pose& to_world, const Eigen::Vector2d& pixel,
           double spacing, Random& random, std::size_t i, GaussianCloud* cloud) {
  const Eigen::Vector3d origin = to_world.translation();
  const Eigen::Vector3d direction = ray(k, to_world, pixel.x(), pixel.y());
  const SurfacePoint point = room.cast(origin, direction);
  cloud->means[i] = (origin + point.distance * direction).cast<float>();

  // The third axis lies along the surface's normal.
  const double radius = 0.6 * spacing * point.distance / k.fx;
  for (int axis = 0; axis < 3; ++axis)
    cloud->log_scales[i][axis] =
        static_cast<float>(std::log(radius * (axis == 2 ? 0.3 : 1)) + random.uniform(-0.5, 0.5));
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), point.normal) *
      Eigen::AngleAxisd(random.uniform(0, 3.14), Eigen::Vector3d::UnitZ());
  cloud->rotations[i] = Eigen::Vector4d(rotation.w(), rotation.x(), rotation.y(), rotation.z()).cast<float>();

  const bool faint = random.uniform(0, 1) < 0.1;
  const double opacity = faint ? random.uniform(0.05, 0.5) : random.uniform(0.5, 0.99);
  cloud->opacity_logits[i] = static_cast<float>(std::log(opacity / (1 - opacity)));
  const Eigen::Vector3f colour = texture(*point.material, point.uv);
  constexpr float kSh0 = 0.28209479f;
  for (std::size_t c = 0; c < 3; ++c) cloud->sh[3 * i + c] = (colour[static_cast<int>(c)] - 0.5f) / kSh0;
}

/// Random pixels, row by row.
std::vector<Eigen::Vector2d> scan_pixels(const Intrinsics& k, std::size_t count, Random& random) {
  std::vector<Eigen::Vector2d> pixels(count);
  for (Eigen::Vector2d& pixel : pixels)
    pixel = {random.uniform(-0.5, k.width - 0.5), random.uniform(-0.5, k.height - 0.5)};
  std::sort(pixels.begin(), pixels.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::pair(std::floor(a.y()), a.x()) < std::pair(std::floor(b.y()), b.x());
  });
  return pixels;
}

/// Like a map that grew keyframe by keyframe, each adding its pixels row by row: neighbours in the map are
/// often neighbours in the image.
void fill_map(const SyntheticRoom& room, const Intrinsics& k, GaussianCloud* cloud) {
  const double pixels = static_cast<double>(k.width) * k.height;
  const double spacing = std::sqrt(pixels / (kVisibleFraction * static_cast<double>(cloud->size())));
  Random random;
  for (int view = 0; view < kViews; ++view) {
    const double seconds = kSecondsAround * (2.0 * view / (kViews - 1) - 1);
    const Pose to_world = room.world_to_camera(seconds).inverse();
    const std::size_t begin = cloud->size() * view / kViews, end = cloud->size() * (view + 1) / kViews;
    const auto targets = scan_pixels(k, end - begin, random);
    for (std::size_t i = begin; i < end; ++i)
      place(room, k, to_world, targets[i - begin], spacing, random, i, cloud);
  }
}

}  // namespace

std::vector<std::string> bench_scene_names() {
  std::vector<std::string> names;
  for (const SceneSize& scene : kScenes) names.emplace_back(scene.name);
  return names;
}

BenchScene make_bench_scene(std::string_view name) {
  const SceneSize* size = nullptr;
  for (const SceneSize& candidate : kScenes)
    if (name == candidate.name) size = &candidate;
  if (!size)
    throw InputError(
        fmt::format("no scene \"{}\" to measure; there are: {}", name, fmt::join(bench_scene_names(), ", ")));

  const SyntheticRoom room;
  BenchScene scene{.name = size->name};
  Intrinsics& k = scene.camera.intrinsics;
  k = {.width = size->width,
       .height = size->height,
       .fx = kFocalPerWidth * size->width,
       .fy = kFocalPerWidth * size->width,
       .cx = 0.5 * (size->width - 1),
       .cy = 0.5 * (size->height - 1)};
  scene.camera.world_to_camera = room.world_to_camera(0);
  const Pose to_world = scene.camera.world_to_camera.inverse();
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u)
      scene.sensor_depth.push_back(
          static_cast<float>(room.cast(to_world.translation(), ray(k, to_world, u, v)).distance));

  scene.cloud.resize(static_cast<std::size_t>(size->gaussians));
  fill_map(room, k, &scene.cloud);
  return scene;
}

BenchScene load_bench_scene(const std::string& map_file, const std::string& camera_file) {
  BenchScene scene{.name = map_file, .cloud = read_ply(map_file).cloud};
  const JsonObject json(camera_file);
  scene.camera.intrinsics = read_intrinsics(json, "width", "height");
  const nlohmann::json& rows = json.at("world_to_camera");
  if (!rows.is_array() || rows.size() != 16) json.fail("world_to_camera", "must be 16 numbers");
  std::vector<double> numbers;
  for (const nlohmann::json& number : rows) {
    if (!number.is_number()) json.fail("world_to_camera", "must be 16 numbers");
    numbers.push_back(number.get<double>());
  }
  const auto pose = rigid_from_rows(numbers);
  if (!pose) json.fail("world_to_camera", "is no rigid transform");
  scene.camera.world_to_camera = *pose;
  return scene;
}

}  // namespace surefield
