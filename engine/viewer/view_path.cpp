#include "engine/viewer/view_path.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace surefield {

namespace {

constexpr float kFaintLogit = -2.2f;       // opacity 0.1
constexpr double kLeftOut = 0.05;          // of the Gaussians: those that an orbit need not show
constexpr std::size_t kMostFramed = 5000;  // Gaussians that an orbit looks at to show all
constexpr double kOrbitRise = 0.45;        // of the orbit's radius, that it lies above the middle
constexpr int kOrbitKeys = 72;
constexpr double kSmallestOrbit = 0.1;  // metres

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Quaterniond turned_by(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& by) {
  const double angle = by.norm();
  if (angle == 0) return rotation;
  return (rotation * Eigen::AngleAxisd(angle, by / angle)).normalized();
}

/// Speeds at the keys from those between them: the speed of the parabola through a key and its neighbours.
std::vector<Eigen::Vector3d> speeds_at_keys(const Trajectory& keys,
                                            const std::vector<Eigen::Vector3d>& between) {
  std::vector<Eigen::Vector3d> speeds(keys.size(), Eigen::Vector3d::Zero());
  if (between.empty()) return speeds;
  speeds.front() = between.front();
  speeds.back() = between.back();
  for (std::size_t i = 1; i + 1 < keys.size(); ++i) {
    const double before = keys[i].timestamp - keys[i - 1].timestamp;
    const double after = keys[i + 1].timestamp - keys[i].timestamp;
    speeds[i] = (after * between[i - 1] + before * between[i]) / (before + after);
  }
  return speeds;
}

/// The point of the cubic Bezier curve by De Casteljau's construction; `mix(a, b, t)` goes from a to b.
template <typename Point, typename Mix>
Point on_curve(std::array<Point, 4> points, double t, Mix mix) {
  for (int last = 3; last > 0; --last)
    for (int i = 0; i < last; ++i) points[i] = mix(points[i], points[i + 1], t);
  return points[0];
}

/// Value of which `share` of the values are smaller; reorders them.
float quantile(std::vector<float>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The centres of the Gaussians that are not faint; of all where all are.
std::vector<Eigen::Vector3f> solid_centres(const GaussianCloud& map) {
  std::vector<Eigen::Vector3f> centres;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (map.opacity_logits[i] > kFaintLogit) centres.push_back(map.means[i]);
  return centres.empty() ? map.means : centres;
}

/// Every so many of them, about kMostFramed.
std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> some;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kMostFramed + 1) some.push_back(points[i]);
  return some;
}

/// Two level directions and up, all of unit length and at right angles.
Eigen::Matrix3d level_axes(const Eigen::Vector3d& up) {
  // The first is behind where the first camera of a run has looked from.
  Eigen::Matrix3d axes;
  axes.col(2) = up.normalized();
  Eigen::Vector3d back = -Eigen::Vector3d::UnitZ() + axes(2, 2) * axes.col(2);
  axes.col(0) = back.norm() < 1e-3 ? axes.col(2).unitOrthogonal() : Eigen::Vector3d(back.normalized());
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// The middle of the box with these axes that leaves out one in twenty at each of its sides.
Eigen::Vector3d box_middle(const std::vector<Eigen::Vector3f>& points, const Eigen::Matrix3d& axes) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::vector<float> values(points.size());
  for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
    const Eigen::Vector3f direction = axes.col(axis).cast<float>();
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Eigen::Vector3f& point) { return point.dot(direction); });
    const double low = quantile(values, kLeftOut), high = quantile(values, 1 - kLeftOut);
    middle += (low + high) / 2 * axes.col(axis);
  }
  return middle;
}

/// From how far off a camera with that rotation, which looks at `middle`, has all but a few points in its
/// picture.
double distance_to_show(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& middle,
                        const Eigen::Matrix3d& rotation, const Intrinsics& lens) {
  const Eigen::Matrix3f to_camera = rotation.transpose().cast<float>();
  const auto wide = static_cast<float>(2 * lens.fx / lens.width),
             high = static_cast<float>(2 * lens.fy / lens.height);
  std::vector<float> distances;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f p = to_camera * (point - middle.cast<float>());
    distances.push_back(std::max(wide * std::abs(p.x()), high * std::abs(p.y())) - p.z());
  }
  return distances.empty() ? 0 : quantile(distances, 1 - kLeftOut);
}

/// A smooth closed curve through the values at evenly spaced angles or above them: their two lowest
/// harmonics, lifted by as much as the curve is below one of them.
std::vector<double> smooth_around(const std::vector<double>& values) {
  const auto count = static_cast<int>(values.size());
  std::vector<double> curve(values.size(), 0);
  for (int harmonic = 0; harmonic <= 2; ++harmonic) {
    const auto wave = [&](int i) { return std::polar(1.0, 2 * std::numbers::pi * harmonic * i / count); };
    std::complex<double> sum = 0;
    for (int i = 0; i < count; ++i) sum += values[i] * std::conj(wave(i)) * (harmonic == 0 ? 1.0 : 2.0);
    for (int i = 0; i < count; ++i) curve[i] += (sum * wave(i)).real() / count;
  }
  double lift = 0;
  for (int i = 0; i < count; ++i) lift = std::max(lift, values[i] - curve[i]);
  for (double& value : curve) value += lift;
  return curve;
}

}  // namespace

Pose look_at(const Eigen::Vector3d& from, const Eigen::Vector3d& at, const Eigen::Vector3d& up) {
  const Eigen::Vector3d forward =
      at == from ? up.unitOrthogonal() : Eigen::Vector3d((at - from).normalized());
  Eigen::Vector3d right = forward.cross(up.normalized());
  right = right.norm() < 1e-6 ? forward.unitOrthogonal() : Eigen::Vector3d(right.normalized());
  Pose pose = Pose::Identity();
  pose.linear() << right, forward.cross(right), forward;
  pose.translation() = from;
  return pose;
}

Eigen::Vector3d up_of(const Trajectory& trajectory) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : trajectory)
    if (pose.is_finite()) up -= pose.camera_to_world.linear().col(1);
  if (up.norm() < 0.1 * static_cast<double>(trajectory.size()) || trajectory.empty())
    return -Eigen::Vector3d::UnitY();
  return up.normalized();
}

Intrinsics fit_to(const Intrinsics& lens, int width, int height) {
  const double scale =
      std::min(static_cast<double>(width) / lens.width, static_cast<double>(height) / lens.height);
  return {.width = width,
          .height = height,
          .fx = scale * lens.fx,
          .fy = scale * lens.fy,
          .cx = scale * (lens.cx - (lens.width - 1) / 2.0) + (width - 1) / 2.0,
          .cy = scale * (lens.cy - (lens.height - 1) / 2.0) + (height - 1) / 2.0};
}

ViewPath::ViewPath(Trajectory keys) : keys_(std::move(keys)) {
  if (keys_.empty()) throw UsageError("a path needs a key");
  std::vector<Eigen::Vector3d> velocities, turning_rates;  // between keys
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (!keys_[i].is_finite()) throw UsageError("a key of a path is not finite");
    const Pose& pose = keys_[i].camera_to_world;
    rotations_.emplace_back(Eigen::Quaterniond(pose.linear()).normalized());
    if (i == 0) continue;
    const double seconds = keys_[i].timestamp - keys_[i - 1].timestamp;
    if (!(seconds > 0)) throw UsageError("the keys of a path are not in the order of time");
    // The shorter of the two ways.
    if (rotations_[i].dot(rotations_[i - 1]) < 0) rotations_[i].coeffs() *= -1;
    velocities.push_back((pose.translation() - keys_[i - 1].camera_to_world.translation()) / seconds);
    turning_rates.push_back(rotation_vector(rotations_[i - 1].conjugate() * rotations_[i]) / seconds);
  }
  velocities_ = speeds_at_keys(keys_, velocities);
  turning_rates_ = speeds_at_keys(keys_, turning_rates);
}

Pose ViewPath::camera_to_world(double seconds) const {
  const auto after =
      std::upper_bound(keys_.begin(), keys_.end(), seconds,
                       [](double time, const StampedPose& key) { return time < key.timestamp; });
  if (after == keys_.begin()) return keys_.front().camera_to_world;
  if (after == keys_.end()) return keys_.back().camera_to_world;
  const auto b = static_cast<std::size_t>(after - keys_.begin()), a = b - 1;
  const double span = keys_[b].timestamp - keys_[a].timestamp;
  const double t = (seconds - keys_[a].timestamp) / span;
  const Eigen::Vector3d from = keys_[a].camera_to_world.translation();
  const Eigen::Vector3d to = keys_[b].camera_to_world.translation();
  Pose pose = Pose::Identity();
  pose.translation() = on_curve<Eigen::Vector3d>(
      {from, from + span / 3 * velocities_[a], to - span / 3 * velocities_[b], to}, t,
      [](const auto& p, const auto& q, double u) -> Eigen::Vector3d { return p + u * (q - p); });
  pose.linear() =
      on_curve<Eigen::Quaterniond>({rotations_[a], turned_by(rotations_[a], span / 3 * turning_rates_[a]),
                                    turned_by(rotations_[b], -span / 3 * turning_rates_[b]), rotations_[b]},
                                   t, [](const auto& p, const auto& q, double u) { return p.slerp(u, q); })
          .normalized()
          .toRotationMatrix();
  return pose;
}

Eigen::Vector3d middle_of(const GaussianCloud& map, const Eigen::Vector3d& up) {
  return box_middle(solid_centres(map), level_axes(up));
}

ViewPath orbit(const GaussianCloud& map, const Intrinsics& lens, const Eigen::Vector3d& up, double seconds) {
  const Eigen::Matrix3d axes = level_axes(up);
  const Eigen::Vector3d middle = middle_of(map, up);
  const std::vector<Eigen::Vector3f> points = thinned(solid_centres(map));
  std::vector<Pose> poses;
  std::vector<double> distances;
  for (int i = 0; i < kOrbitKeys; ++i) {
    const double angle = 2 * std::numbers::pi * i / kOrbitKeys;
    const Eigen::Vector3d out =
        axes * Eigen::Vector3d(std::cos(angle), std::sin(angle), kOrbitRise).normalized();
    poses.push_back(look_at(middle + out, middle, axes.col(2)));
    distances.push_back(
        std::max(kSmallestOrbit, distance_to_show(points, middle, poses.back().linear(), lens)));
  }
  distances = smooth_around(distances);
  Trajectory keys;
  for (int i = 0; i <= kOrbitKeys; ++i) {
    const int key = i % kOrbitKeys;
    keys.push_back({seconds * i / kOrbitKeys, poses[key]});
    keys.back().camera_to_world.translation() = middle - distances[key] * poses[key].linear().col(2);
  }
  return ViewPath(std::move(keys));
}

}  // namespace surefield
