#include "engine/viewer/cutaway.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "engine/formats/gaussian_order.h"

namespace surefield {

namespace {

constexpr std::size_t kMostCameras = 100;  // that are asked which side they saw
constexpr float kWidestView = 0.6f;        // cosine with the optical axis of what a camera is taken to see
constexpr float kFlatShare = 0.5f;  // of its second axis, the shortest one of a Gaussian that has two sides

/// From nothing to everything between two values.
struct Ramp {
  float from, to;

  float at(float value) const {
    const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
  }
};

constexpr Ramp kNear{0.25f, 0.4f};    // distance from the lens, of that of the middle
constexpr float kCell = 0.03f;        // of the map's extent, over which fronts are averaged
constexpr Ramp kFacing{-0.1f, 0.1f};  // cosine between the front and the direction to the camera
constexpr float kInvisible = 1.0f / 255;

/// Cameras that are evenly picked.
std::vector<Eigen::Isometry3f> some_of(const Trajectory& trajectory) {
  std::vector<Eigen::Isometry3f> cameras;
  const std::size_t stride = std::max<std::size_t>(1, trajectory.size() / kMostCameras);
  for (std::size_t i = 0; i < trajectory.size(); i += stride)
    if (trajectory[i].is_finite()) cameras.push_back(trajectory[i].camera_to_world.cast<float>());
  return cameras;
}

/// The sum of the directions to the cameras that see a point, the near ones counting more; zero where none
/// does.
Eigen::Vector3f seen_along(const Eigen::Vector3f& point, const std::vector<Eigen::Isometry3f>& cameras) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Eigen::Isometry3f& camera : cameras) {
    const Eigen::Vector3f to_camera = camera.translation() - point;
    const float distance = to_camera.norm();
    if (!(distance > 0) || -to_camera.dot(camera.linear().col(2)) < kWidestView * distance) continue;
    sum += to_camera / (distance * distance * distance);
  }
  return sum;
}

/// Zero for a Gaussian that is no disc.
Eigen::Vector3f normal_of(const GaussianCloud& map, std::size_t i) {
  const Eigen::Vector3f scales = map.log_scales[i].array().exp();
  int shortest = 0;
  const float least = scales.minCoeff(&shortest), middle = scales.sum() - least - scales.maxCoeff();
  if (!(least < kFlatShare * middle) || map.rotations[i].isZero()) return Eigen::Vector3f::Zero();
  const Eigen::Vector4f q = map.rotations[i].normalized();
  return Eigen::Quaternionf(q[0], q[1], q[2], q[3]).toRotationMatrix().col(shortest);
}

/// The directions that the pieces of a surface face, summed over the cells of a grid.
class FrontGrid {
 public:
  explicit FrontGrid(float cell) : cell_(cell) {}

  void add(const Eigen::Vector3f& place, const Eigen::Vector3f& front) {
    sums_.try_emplace(key_of(cell_of(place)), Eigen::Vector3f::Zero()).first->second += front;
  }

  /// Over the cell that holds the place and those around it.
  Eigen::Vector3f around(const Eigen::Vector3f& place) const {
    const Eigen::Vector3i middle = cell_of(place);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int i = 0; i < 27; ++i) {
      const auto found = sums_.find(key_of(middle + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
      if (found != sums_.end()) sum += found->second;
    }
    return sum;
  }

 private:
  Eigen::Vector3i cell_of(const Eigen::Vector3f& place) const {
    return (place / cell_).array().floor().cwiseMax(-kMostCells).cwiseMin(kMostCells).cast<int>();
  }
  static int64_t key_of(const Eigen::Vector3i& cell) {
    return (int64_t{cell.x()} * kKeyStride + cell.y()) * kKeyStride + cell.z();
  }

  static constexpr float kMostCells = 500000;  // to each side; what lies farther off shares the last one
  static constexpr int64_t kKeyStride = int64_t{1} << 20;

  float cell_;
  std::unordered_map<int64_t, Eigen::Vector3f> sums_;
};

/// From the median along each axis, how far off nine in ten Gaussians are at most, metres.
float extent_of(const GaussianCloud& map) {
  float extent = 0;
  std::vector<float> values(map.size());
  for (int axis = 0; axis < 3 && !values.empty(); ++axis) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = map.means[i][axis];
    const auto at = [&](double share) {
      const auto place =
          values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), place, values.end());
      return *place;
    };
    const float low = at(0.05);
    extent = std::max(extent, at(0.95) - low);
  }
  return extent;
}

/// Of its two longer axes, square metres; of no more than a cell's.
float area_of(const GaussianCloud& map, std::size_t i) {
  const Eigen::Vector3f& scales = map.log_scales[i];
  return std::exp(std::min(scales.sum() - scales.minCoeff(), 0.0f));
}

float faded(float logit, float share) {
  const float opacity = share / (1 + std::exp(-logit));
  return std::log(opacity / (1 - opacity));
}

}  // namespace

Cutaway::Cutaway(GaussianCloud map, const Trajectory& trajectory)
    : map_(std::move(map)), fronts_(map_.size(), Eigen::Vector3f::Zero()) {
  const std::vector<Eigen::Isometry3f> cameras = some_of(trajectory);
  FrontGrid grid(std::max(kCell * extent_of(map_), 1e-3f));
  for (std::size_t i = 0; i < map_.size(); ++i) {
    const Eigen::Vector3f seen = seen_along(map_.means[i], cameras), normal = normal_of(map_, i);
    if (seen.isZero(0)) continue;
    fronts_[i] = normal.isZero() ? Eigen::Vector3f(seen.stableNormalized())
                                 : Eigen::Vector3f(normal.dot(seen) < 0 ? -normal : normal);
    grid.add(map_.means[i], area_of(map_, i) * fronts_[i]);
  }
  // Single normals are noisy, and the sides of the books go with their shelf.
  for (std::size_t i = 0; i < map_.size(); ++i)
    if (!fronts_[i].isZero()) fronts_[i] = grid.around(map_.means[i]).stableNormalized();
}

GaussianCloud Cutaway::seen_from(const Pose& camera_to_world, const Eigen::Vector3d& middle) const {
  const Eigen::Vector3f eye = camera_to_world.translation().cast<float>();
  const float reach = (middle.cast<float>() - eye).norm();
  std::vector<std::size_t> kept;
  std::vector<float> shares;
  for (std::size_t i = 0; i < map_.size(); ++i) {
    const Eigen::Vector3f off = map_.means[i] - eye;
    const float distance = off.norm();
    float share = kNear.at(distance / reach);
    if (!fronts_[i].isZero()) share *= kFacing.at(-fronts_[i].dot(off) / distance);
    if (!(share > kInvisible)) continue;
    kept.push_back(i);
    shares.push_back(share);
  }
  GaussianCloud shown = select(map_, kept);
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (shares[k] < 1) shown.opacity_logits[k] = faded(shown.opacity_logits[k], shares[k]);
  return shown;
}

}  // namespace surefield
