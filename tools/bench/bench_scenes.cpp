#include "tools/bench/bench_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/io/camera_json.h"
#include "engine/io/json_file.h"
#include "engine/io/text_file.h"
#include "engine/synth/camera_path.h"
#include "engine/synth/scene_renderer.h"
#include "engine/types/error.h"
#include "tools/shared/load_map.h"

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
constexpr SceneSize kScenes[] = {{"small", 20'000, 160, 120},
                                 {"medium", 50'000, 320, 240},
                                 {"large", 150'000, 640, 480},
                                 {"huge", 800'000, 1200, 680}};

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

/// A view of the office.
struct SeenView {
  Camera camera;
  SceneImages images;
};

/// Puts Gaussian `i` on the surface that the view shows at `pixel`; `spacing` in pixels.
void place(const Scene& office, const SeenView& view, const cv::Point& pixel, double spacing, Random& random,
           std::size_t i, GaussianCloud* cloud) {
  const Intrinsics& k = view.camera.intrinsics;
  const Pose to_world = view.camera.world_to_camera.inverse();
  const double depth = view.images.depth.at<float>(pixel);
  const Eigen::Vector3d point = to_world.translation() + depth * ray(k, to_world, pixel.x, pixel.y);
  cloud->means[i] = point.cast<float>();

  // The third axis lies along the surface's normal.
  const double radius = 0.6 * spacing * depth / k.fx;
  for (int axis = 0; axis < 3; ++axis)
    cloud->log_scales[i][axis] =
        static_cast<float>(std::log(radius * (axis == 2 ? 0.3 : 1)) + random.uniform(-0.5, 0.5));
  const Shape& shape = office.shapes[static_cast<std::size_t>(view.images.shapes.at<int>(pixel))];
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), shape.outward_normal(point)) *
      Eigen::AngleAxisd(random.uniform(0, 3.14), Eigen::Vector3d::UnitZ());
  cloud->rotations[i] = Eigen::Vector4d(rotation.w(), rotation.x(), rotation.y(), rotation.z()).cast<float>();

  const bool faint = random.uniform(0, 1) < 0.1;
  const double opacity = faint ? random.uniform(0.05, 0.5) : random.uniform(0.5, 0.99);
  cloud->opacity_logits[i] = static_cast<float>(std::log(opacity / (1 - opacity)));
  const auto& colour = view.images.colour.at<cv::Vec3b>(pixel);
  constexpr float kSh0 = 0.28209479f;
  for (int c = 0; c < 3; ++c)
    cloud->sh[3 * i + static_cast<std::size_t>(c)] = (static_cast<float>(colour[c]) / 255 - 0.5f) / kSh0;
}

/// Random pixels, row by row.
std::vector<cv::Point> scan_pixels(const Intrinsics& k, std::size_t count, Random& random) {
  std::vector<cv::Point> pixels(count);
  for (cv::Point& pixel : pixels) {
    pixel.x = static_cast<int>(random.uniform(0, k.width));
    pixel.y = static_cast<int>(random.uniform(0, k.height));
  }
  std::sort(pixels.begin(), pixels.end(),
            [](const cv::Point& a, const cv::Point& b) { return std::pair(a.y, a.x) < std::pair(b.y, b.x); });
  return pixels;
}

/// Like a map that grew keyframe by keyframe, each adding its pixels row by row: neighbours in the map are
/// often neighbours in the image.
void fill_map(const Scene& office, const SceneRenderer& renderer, const CameraPath& path, BenchScene* scene) {
  const Intrinsics& k = scene->camera.intrinsics;
  const std::size_t count = scene->cloud.size();
  const double pixels = static_cast<double>(k.width) * k.height;
  const double spacing = std::sqrt(pixels / (kVisibleFraction * static_cast<double>(count)));
  Random random;
  for (int i = 0; i < kViews; ++i) {
    const Camera camera{k, path.world_to_camera(2 * kSecondsAround * i / (kViews - 1))};
    const SeenView view{camera, renderer.render(camera)};
    const std::size_t begin = count * i / kViews, end = count * (i + 1) / kViews;
    const auto targets = scan_pixels(k, end - begin, random);
    for (std::size_t n = begin; n < end; ++n)
      place(office, view, targets[n - begin], spacing, random, n, &scene->cloud);
  }
}

}  // namespace

std::vector<std::string> bench_scene_names() {
  std::vector<std::string> names;
  for (const SceneSize& scene : kScenes) names.emplace_back(scene.name);
  return names;
}

BenchScene make_bench_scene(gpu::Device& device, std::string_view name) {
  const SceneSize* size = nullptr;
  for (const SceneSize& candidate : kScenes)
    if (name == candidate.name) size = &candidate;
  if (!size)
    throw InputError(
        fmt::format("no scene \"{}\" to measure; there are: {}", name, fmt::join(bench_scene_names(), ", ")));

  const Scene office = make_scene("office", 1);
  const CameraPath path(office, path_style("handheld"), 1, 2 * kSecondsAround);
  const SceneRenderer renderer(device, office);
  BenchScene scene{.name = size->name};
  Intrinsics& k = scene.camera.intrinsics;
  k = {.width = size->width,
       .height = size->height,
       .fx = kFocalPerWidth * size->width,
       .fy = kFocalPerWidth * size->width,
       .cx = 0.5 * (size->width - 1),
       .cy = 0.5 * (size->height - 1)};
  scene.camera.world_to_camera = path.world_to_camera(kSecondsAround);
  const SceneImages seen = renderer.render(scene.camera);
  scene.sensor_colour.assign(seen.colour.datastart, seen.colour.dataend);
  scene.sensor_depth.assign(seen.depth.begin<float>(), seen.depth.end<float>());
  scene.cloud.resize(static_cast<std::size_t>(size->gaussians));
  fill_map(office, renderer, path, &scene);
  return scene;
}

BenchScene load_bench_scene(const std::string& map_file, const std::string& camera_file) {
  BenchScene scene{.name = map_file, .cloud = load_map(map_file)};
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
