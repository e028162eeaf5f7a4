#include "engine/synth/camera_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/synth/random.h"
#include "engine/types/error.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kRate = 240;              // samples a second
constexpr double kMargin = 0.25;           // seconds before the start and after the end
constexpr double kClearance = 0.25;        // metres
constexpr std::size_t kClearanceStep = 8;  // samples between two that are checked
constexpr double kLookAhead = 0.7;         // metres
constexpr int kPiecesPerStop = 400;        // of the spline between two stops
constexpr int kAttempts = 30;
constexpr double kPitchAhead = -8 * kDegree;
constexpr double kShakeAngle = 0.4 * kDegree;
constexpr double kShakeDistance = 0.003;  // metres
constexpr double kShakeTurn = 0.09;       // radians a second, at most, that shaking adds

constexpr PathStyle kStyles[] = {
    {"robot", 0.25, 0.05, 30 * kDegree, 0.0, 0, true, 1.2},
    {"handheld", 0.45, 0.08, 55 * kDegree, 0.15, 1, false, 0},
    {"fast", 0.98, 0.12, 115 * kDegree, 0.2, 1.6, false, 0},
    {"loop", 0.45, 0.08, 55 * kDegree, 0.0, 1, false, 0},
    // 370 degrees in 250 frames.
    {"turn", 0.387, 0, 60 * kDegree, 0.0, 1, false, 0, 0.5},
};

/// A uniform cubic B-spline through the neighbourhood of its points, at `u` from point 1 on.
Vector3d spline(const std::vector<Vector3d>& points, double u) {
  const auto i = std::min(static_cast<std::size_t>(u), points.size() - 4);
  const double f = u - static_cast<double>(i), f2 = f * f, f3 = f2 * f;
  return ((1 - 3 * f + 3 * f2 - f3) * points[i] + (4 - 6 * f2 + 3 * f3) * points[i + 1] +
          (1 + 3 * f + 3 * f2 - 3 * f3) * points[i + 2] + f3 * points[i + 3]) /
         6;
}

/// Control points of position and of what is looked at.
struct Controls {
  std::vector<Vector3d> positions, looks;
};

/// So many stops of the circuit, beginning anywhere; `jitter` metres off.
Controls follow(const Scene& scene, const PathStyle& style, RandomStream random, std::size_t stops,
                double jitter) {
  Controls controls;
  const std::size_t round = scene.circuit.size();
  const int anywhere = random.index(static_cast<int>(round));
  // The spline begins at its second point.
  const auto first = scene.first_stop < 0 ? static_cast<std::size_t>(anywhere)
                                          : (static_cast<std::size_t>(scene.first_stop) + round - 1) % round;
  const auto off = [&](double size) {
    // One after the other: the order in which a call's arguments are computed differs between compilers.
    const double z = random.uniform(-0.6 * size, 0.6 * size);
    const double y = random.uniform(-size, size), x = random.uniform(-size, size);
    return Vector3d(x, y, z);
  };
  for (std::size_t i = 0; i < stops; ++i) {
    const Waypoint& stop = scene.circuit[(first + i) % round];
    controls.positions.push_back(stop.position + off(jitter));
    if (style.look_ahead) controls.positions.back().z() = style.height;
    controls.looks.push_back(stop.look + off(2 * jitter));
  }
  return controls;
}

/// A curve by its length: the spline's parameter at evenly spaced fractions of it.
class Arc {
 public:
  explicit Arc(const std::vector<Vector3d>& points) : points_(points) {
    const auto pieces = (points.size() - 3) * kPiecesPerStop;
    lengths_.push_back(0);
    for (std::size_t i = 0; i < pieces; ++i) lengths_.push_back(lengths_.back() + (at(i + 1) - at(i)).norm());
  }

  double length() const { return lengths_.back(); }

  /// The spline's parameter after so many metres.
  double parameter(double metres) const {
    const auto after = std::upper_bound(lengths_.begin(), lengths_.end() - 1, metres);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - lengths_.begin() - 1, 0));
    const double piece = lengths_[i + 1] - lengths_[i];
    return (static_cast<double>(i) + (piece > 0 ? (metres - lengths_[i]) / piece : 0)) / kPiecesPerStop;
  }

 private:
  Vector3d at(std::size_t piece) const {
    return spline(points_, static_cast<double>(piece) / kPiecesPerStop);
  }

  const std::vector<Vector3d>& points_;
  std::vector<double> lengths_;
};

double wrap(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

/// Averages with Gaussian weights; the ends are repeated.
std::vector<double> smoothed(const std::vector<double>& values, double sigma) {
  const int reach = static_cast<int>(3 * sigma);
  std::vector<double> weights;
  for (int i = -reach; i <= reach; ++i) weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
  const auto last = static_cast<int>(values.size()) - 1;
  std::vector<double> result(values.size());
  for (int i = 0; i <= last; ++i) {
    double sum = 0, total = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = weights[static_cast<std::size_t>(k + reach)];
      sum += weight * values[static_cast<std::size_t>(std::clamp(i + k, 0, last))];
      total += weight;
    }
    result[static_cast<std::size_t>(i)] = sum / total;
  }
  return result;
}

double fastest_turn(const std::vector<double>& yaw, const std::vector<double>& pitch) {
  double fastest = 0;
  for (std::size_t i = 1; i < yaw.size(); ++i)
    fastest = std::max(fastest, kRate * std::hypot(yaw[i] - yaw[i - 1], pitch[i] - pitch[i - 1]));
  return fastest;
}

/// A sum of three sines with incommensurable periods, -1 to 1.
double tremble(double seconds, uint32_t seed, uint32_t channel) {
  double sum = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    const double hertz = 0.55 + 0.62 * i + 0.2 * unit_interval(hash_key(seed, channel, i, 1));
    sum += std::sin(2 * std::numbers::pi * (hertz * seconds + unit_interval(hash_key(seed, channel, i, 2)))) /
           (1 + i);
  }
  return sum / 1.84;
}

/// How near anything comes to a level circle, metres.
double clearance_of_circle(const Scene& scene, const Vector3d& centre, double radius) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 16; ++i) {
    const double angle = i * std::numbers::pi / 8;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    nearest = std::min(nearest, scene.clearance(centre + radius * out));
  }
  return nearest;
}

}  // namespace

std::vector<std::string> path_names() {
  std::vector<std::string> names;
  for (const PathStyle& style : kStyles) names.emplace_back(style.name);
  return names;
}

const PathStyle& path_style(const std::string& name) {
  for (const PathStyle& style : kStyles)
    if (name == style.name) return style;
  throw InputError(fmt::format("unknown path \"{}\"; there are: {}", name, fmt::join(path_names(), ", ")));
}

CameraPath::CameraPath(const Scene& scene, const PathStyle& style, uint32_t seed, double seconds)
    : shake_(style.shake), seed_(seed) {
  const auto count = static_cast<std::size_t>((seconds + 2 * kMargin) * kRate) + 2;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const double jitter = style.jitter * (1 - static_cast<double>(attempt) / (kAttempts - 1));
    samples_.clear();
    if (style.circle > 0)
      turn_round(scene, style, count);
    else
      walk(scene, style, jitter, count);
    if (!is_clear(scene)) continue;
    limit_turns(style);
    return;
  }
  throw InputError(
      fmt::format("scene {}: no way through it for a camera of the path {}", scene.name, style.name));
}

void CameraPath::walk(const Scene& scene, const PathStyle& style, double jitter, std::size_t count) {
  double round = 0;
  const std::size_t stops_around = scene.circuit.size();
  for (std::size_t i = 0; i < stops_around; ++i)
    round += (scene.circuit[i].position - scene.circuit[(i + 1) % stops_around].position).norm();
  // The spline cuts corners: one lap more than the polygon asks for.
  const double laps = static_cast<double>(count) / kRate * (style.speed + style.speed_swing) / round;
  const auto stops = static_cast<std::size_t>(std::ceil(1.3 * laps + 1)) * stops_around + 4;
  const Controls controls = follow(scene, style, RandomStream(hash_key(seed_, 1)), stops, jitter);
  const Arc arc(controls.positions);
  double metres = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double seconds = static_cast<double>(i) / kRate - kMargin, u = arc.parameter(metres);
    const Vector3d position = spline(controls.positions, u);
    const Vector3d ahead = spline(controls.positions, arc.parameter(metres + kLookAhead));
    const Vector3d d = (style.look_ahead ? ahead : spline(controls.looks, u)) - position;
    const double yaw = std::atan2(d.y(), d.x());
    const double before = samples_.empty() ? yaw : samples_.back().yaw;
    const double pitch = style.look_ahead ? kPitchAhead : std::atan2(d.z(), d.head<2>().norm());
    samples_.push_back({position, before + wrap(yaw - before), pitch});
    if (u < static_cast<double>(stops_around)) lap_seconds_ = seconds;
    metres += (style.speed + style.speed_swing * tremble(0.2 * seconds, seed_, 9)) / kRate;
  }
}

void CameraPath::turn_round(const Scene& scene, const PathStyle& style, std::size_t count) {
  Vector3d centre = scene.circuit.front().position;
  double most_room = 0;
  for (const Waypoint& stop : scene.circuit) {
    const double room = clearance_of_circle(scene, stop.position, style.circle);
    if (room > most_room) centre = stop.position;
    most_room = std::max(most_room, room);
  }
  const double start = 2 * std::numbers::pi * unit_interval(hash_key(seed_, 2));
  for (std::size_t i = 0; i < count; ++i) {
    const double seconds = static_cast<double>(i) / kRate - kMargin;
    const double yaw = start + style.speed / style.circle * seconds;
    samples_.push_back({centre + style.circle * Vector3d(std::cos(yaw), std::sin(yaw), 0), yaw, kPitchAhead});
  }
  lap_seconds_ = 2 * std::numbers::pi * style.circle / style.speed;
}

bool CameraPath::is_clear(const Scene& scene) const {
  for (std::size_t i = 0; i < samples_.size(); i += kClearanceStep)
    if (scene.clearance(samples_[i].position) < kClearance) return false;
  return true;
}

void CameraPath::limit_turns(const PathStyle& style) {
  std::vector<double> yaw, pitch;
  for (const Sample& sample : samples_) {
    yaw.push_back(sample.yaw);
    pitch.push_back(sample.pitch);
  }
  const double limit = style.turn_limit - kShakeTurn * style.shake;
  std::vector<double> smooth_yaw, smooth_pitch;
  double sigma = 0.12 * kRate;
  do {
    smooth_yaw = smoothed(yaw, sigma);
    smooth_pitch = smoothed(pitch, sigma);
    sigma *= 1.25;
  } while (fastest_turn(smooth_yaw, smooth_pitch) > limit);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    samples_[i].yaw = smooth_yaw[i];
    samples_[i].pitch = smooth_pitch[i];
  }
}

Pose CameraPath::world_to_camera(double seconds) const {
  const double at =
      std::clamp((seconds + kMargin) * kRate, 1.0, static_cast<double>(samples_.size()) - 3.001);
  const auto i = static_cast<std::size_t>(at);
  const double f = at - static_cast<double>(i);
  // The cubic through four samples (Catmull and Rom).
  const auto blend = [&](const auto& value) {
    const auto a = value(samples_[i - 1]), b = value(samples_[i]), c = value(samples_[i + 1]),
               d = value(samples_[i + 2]);
    return (b + 0.5 * f * ((c - a) + f * ((2 * a - 5 * b + 4 * c - d) + f * (3 * (b - c) + d - a)))).eval();
  };
  const Vector3d position = blend([](const Sample& s) { return s.position; });
  const Eigen::Vector2d angles = blend([](const Sample& s) { return Eigen::Vector2d(s.yaw, s.pitch); });
  const auto shaken = [&](uint32_t channel) { return shake_ * tremble(seconds, seed_, channel); };
  const double yaw = angles.x() + kShakeAngle * shaken(0), pitch = angles.y() + kShakeAngle * shaken(1);

  const Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d level;
  level << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(2 * kShakeAngle * shaken(2), Vector3d::UnitZ()) * level;
  pose.translation() =
      -(pose.linear() * (position + kShakeDistance * Vector3d(shaken(3), shaken(4), shaken(5))));
  return pose;
}

}  // namespace surefield
