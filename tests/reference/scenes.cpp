#include "tests/reference/scenes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace surefield::reference {

namespace {

/// Uniform numbers that are the same on every platform, which those of std::uniform_real_distribution need
/// not be.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }

  /// 0 to count - 1.
  int index(int count) { return static_cast<int>(uniform(0, count)); }

  Eigen::Vector3d vector(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
    return {x, y, z};
  }

 private:
  std::mt19937 engine_;
};

Camera random_camera(Random& random, const SceneOptions& options) {
  Camera camera;
  Intrinsics& k = camera.intrinsics;
  k.width = options.width;
  k.height = options.height;
  k.fx = options.width * 0.9;
  k.fy = options.width * 0.95;
  k.cx = options.width * 0.47;
  k.cy = options.height * 0.55;
  const Eigen::Vector3d axis = random.vector(-1, 1).normalized();
  camera.world_to_camera.linear() = Eigen::AngleAxisd(random.uniform(0.3, 2.5), axis).toRotationMatrix();
  camera.world_to_camera.translation() = random.vector(-1.5, 1.5);
  return camera;
}

/// One Gaussian in the camera frame, in the terms in which kinds differ.
struct Blob {
  double u = 0, v = 0;    ///< image position, as a fraction of width and height
  double depth = 0;       ///< metres
  double radius = 0;      ///< pixels
  double anisotropy = 0;  ///< the natural logarithms of its scales differ by up to this
  double opacity = 0.5;
};

Blob random_blob(Random& random, SceneKind kind, int width) {
  Blob blob;
  blob.u = random.uniform(0.05, 0.95);
  blob.v = random.uniform(0.05, 0.95);
  blob.depth = random.uniform(1, 4);
  blob.radius = random.uniform(1.5, 4);
  blob.anisotropy = 0.7;
  blob.opacity = random.uniform(0.2, 0.9);
  switch (kind) {
    case SceneKind::isotropic_small:
      blob.radius = random.uniform(0.3, 1.5);
      blob.anisotropy = 0;
      break;
    case SceneKind::anisotropic:
      // Wide enough for the blur of 0.3 pixels^2 to leave thin ones thin.
      blob.radius = random.uniform(3, 12);
      blob.anisotropy = std::log(30.0);
      break;
    case SceneKind::behind_camera:
      if (random.index(2) == 0) blob.depth = random.uniform(-3, 0.0099);
      break;
    case SceneKind::at_border:
      // The tangents are clamped from 0.15 of the image's size beyond the border.
      (random.index(2) == 0 ? blob.u : blob.v) =
          random.index(2) == 0 ? random.uniform(-0.3, 0.05) : random.uniform(0.95, 1.3);
      blob.radius = random.uniform(2, 8);
      break;
    case SceneKind::larger_than_image:
      blob.radius = width * random.uniform(0.8, 1.5);
      blob.opacity = random.uniform(0.02, 0.3);
      break;
    case SceneKind::low_opacity:
      blob.opacity = random.uniform(0.0005, 0.02);
      break;
    case SceneKind::high_opacity:
      blob.opacity = random.uniform(0.98, 0.9999);
      blob.radius = random.uniform(3, 20);
      break;
    case SceneKind::mixed:
      break;
  }
  return blob;
}

void add_gaussian(Random& random, const Blob& blob, const Camera& camera, GaussianCloud& cloud) {
  const Intrinsics& k = camera.intrinsics;
  const Eigen::Vector3d ray((blob.u * k.width - k.cx) / k.fx, (blob.v * k.height - k.cy) / k.fy, 1);
  cloud.means.push_back((camera.world_to_camera.inverse() * Eigen::Vector3d(ray * blob.depth)).cast<float>());
  const double scale = std::log(blob.radius * std::max(std::abs(blob.depth), 0.1) / k.fx);
  Eigen::Vector3d log_scales = Eigen::Vector3d::Constant(scale);
  for (int axis = 0; axis < 3; ++axis) log_scales[axis] -= random.uniform(0, 1) * blob.anisotropy;
  cloud.log_scales.push_back(log_scales.cast<float>());
  const Eigen::Vector3d imaginary = random.vector(-1, 1);
  const Eigen::Vector4d rotation(random.uniform(-1, 1), imaginary.x(), imaginary.y(), imaginary.z());
  cloud.rotations.push_back((rotation.normalized() * random.uniform(0.5, 2)).cast<float>());
  cloud.opacity_logits.push_back(static_cast<float>(std::log(blob.opacity / (1 - blob.opacity))));
  cloud.uncertainty.push_back(0.0f);
  // One in three was never seen from nearer, and one in three knows nothing of it.
  const double widths = cloud.size() % 3 == 0 ? 0
                                              : random.uniform(cloud.size() % 3 == 1 ? 0.2 : 1.1,
                                                               cloud.size() % 3 == 1 ? 0.9 : 3);
  cloud.anchors.push_back(0);
  cloud.sampling.push_back(static_cast<float>(widths * std::abs(blob.depth) / std::sqrt(k.fx * k.fy)));
  for (int c = 0; c < sh_coefficients(cloud.sh_degree); ++c) {
    // About one channel in ten of degree 0 comes out negative.
    const double low = c == 0 ? -2.2 : -0.3, high = c == 0 ? 1.8 : 0.3;
    for (int channel = 0; channel < 3; ++channel)
      cloud.sh.push_back(static_cast<float>(random.uniform(low, high)));
  }
}

float random_depth(Random& random) {
  const float invalid[] = {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity()};
  const int choice = random.index(24);
  return choice < 4 ? invalid[choice] : static_cast<float>(random.uniform(1, 4));
}

}  // namespace

Scene random_scene(uint32_t seed, int count, const SceneOptions& options) {
  Random random(seed);
  Scene scene;
  scene.camera = random_camera(random, options);
  scene.cloud.sh_degree = options.sh_degree;
  constexpr int kinds = static_cast<int>(SceneKind::mixed);
  for (int i = 0; i < count; ++i) {
    const SceneKind kind =
        options.kind == SceneKind::mixed ? static_cast<SceneKind>(random.index(kinds)) : options.kind;
    add_gaussian(random, random_blob(random, kind, options.width), scene.camera, scene.cloud);
  }
  for (int pixel = 0; pixel < options.width * options.height; ++pixel) {
    scene.depth.push_back(random_depth(random));
    for (int channel = 0; channel < 3; ++channel)
      scene.colour.push_back(static_cast<float>(random.uniform(0, 1)));
  }
  return scene;
}

}  // namespace surefield::reference
