#include "engine/viewer/pick.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/viewer/scales.h"

namespace surefield {

namespace {

constexpr double kHiddenBy = 1.02;  // of the surface's depth, from which on it hides a frustum (as for lines)
constexpr double kMarkPixels = 12;
const Eigen::Vector4f kMark(1, 0.95f, 0.2f, 1);
const Eigen::Vector4f kNormal(1, 0.4f, 0.9f, 1);

/// The shortest axis of a Gaussian, unit length, turned against `ray`.
Eigen::Vector3d normal_of(const GaussianCloud& map, std::size_t i, const Eigen::Vector3d& ray) {
  Eigen::Index shortest = 0;
  map.log_scales[i].minCoeff(&shortest);
  const Eigen::Vector4d q = map.rotations[i].cast<double>().normalized();
  const Eigen::Vector3d axis = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix().col(shortest);
  return axis.dot(ray) > 0 ? Eigen::Vector3d(-axis) : axis;
}

/// How far a place of the picture is from a segment, pixels.
double distance_from(const Eigen::Vector2d& place, const glsl::LineSegment& segment) {
  const Eigen::Vector2d from(segment.from.x, segment.from.y), to(segment.to.x, segment.to.y);
  const double length = std::max((to - from).squaredNorm(), 1e-12);
  const double t = std::clamp((place - from).dot(to - from) / length, 0.0, 1.0);
  return (place - from - t * (to - from)).norm();
}

/// Whether a camera has a point in its image; its distance from the point, or infinity.
double distance_if_seen(const Camera& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = camera.world_to_camera * point;
  const Intrinsics& k = camera.intrinsics;
  const double u = k.fx * p.x() / p.z() + k.cx, v = k.fy * p.y() / p.z() + k.cy;
  const bool seen = p.z() > 0 && u >= -0.5 && u <= k.width - 0.5 && v >= -0.5 && v <= k.height - 0.5;
  return seen ? p.norm() : std::numeric_limits<double>::infinity();
}

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("{:.4f},{:.4f},{:.4f}", v.x(), v.y(), v.z());
}

}  // namespace

std::optional<Pick> pick(const RenderImages& images, const Camera& camera, const GaussianCloud& map,
                         const Eigen::Vector2i& pixel) {
  if (pixel.minCoeff() < 0 || pixel.x() >= images.width || pixel.y() >= images.height) return std::nullopt;
  const auto at = static_cast<std::size_t>(pixel.y()) * images.width + pixel.x();
  const double depth = images.depth_median[at];
  const int gaussian = images.dominator[at];
  if (!(depth > 0) || gaussian < 0) return std::nullopt;
  const auto i = static_cast<std::size_t>(gaussian);
  const Intrinsics& k = camera.intrinsics;
  const Eigen::Vector3d ray((pixel.x() - k.cx) / k.fx, (pixel.y() - k.cy) / k.fy, 1);
  const Pose camera_to_world = camera.world_to_camera.inverse();
  Pick pick{.pixel = pixel, .point = camera_to_world * (depth * ray), .depth = depth, .gaussian = gaussian};
  pick.normal = normal_of(map, i, camera_to_world.linear() * ray);
  if (map.uncertainty[i] > 0) pick.sigma = std::sqrt(static_cast<double>(map.uncertainty[i]));
  return pick;
}

std::optional<PickedKeyframe> keyframe_under(const ViewerScene& scene, const OverlayChoice& choice,
                                             const Camera& camera, const std::optional<Pick>& surface,
                                             const Eigen::Vector2d& place, double reach) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Intrinsics& lens = scene.frame.camera.intrinsics;
  if (lens.width <= 0) return std::nullopt;
  const double hidden_from = surface && !choice.on_top ? kHiddenBy * surface->depth : kNone;
  double nearest_pointed = kNone, nearest_seeing = kNone;
  int pointed = -1, seeing = -1;
  for (std::size_t i = 0; i < scene.keyframes.size(); ++i) {
    const Camera keyframe{lens, scene.keyframes[i].camera_to_world.inverse()};
    std::vector<Line> lines;
    if (choice.keyframes) add_frustum(lines, keyframe, choice.keyframe_frustum(), {});
    const double depth = (camera.world_to_camera * scene.keyframes[i].camera_to_world.translation()).z();
    for (const glsl::LineSegment& segment : project_lines(lines, camera))
      if (depth < std::min(nearest_pointed, hidden_from) && distance_from(place, segment) <= reach) {
        nearest_pointed = depth;
        pointed = static_cast<int>(i);
      }
    const double distance = surface ? distance_if_seen(keyframe, surface->point) : kNone;
    if (distance < nearest_seeing) {
      nearest_seeing = distance;
      seeing = static_cast<int>(i);
    }
  }
  if (pointed >= 0) return PickedKeyframe{pointed, true};
  if (seeing >= 0) return PickedKeyframe{seeing, false};
  return std::nullopt;
}

std::string describe(const Under& under) {
  std::string text;
  if (const auto& s = under.surface) {
    text = fmt::format("pixel={},{} point={} depth={:.4f}", s->pixel.x(), s->pixel.y(), vector_text(s->point),
                       s->depth);
    if (s->sigma) text += fmt::format(" sigma={:.4f}", *s->sigma);
    text += fmt::format(" normal={} gaussian={}", vector_text(s->normal), s->gaussian);
  }
  if (under.keyframe) {
    if (!text.empty()) text += ' ';
    text += fmt::format("keyframe={}{}", under.keyframe->index, under.keyframe->pointed ? " pointed" : "");
  }
  return text.empty() ? "nothing" : text;
}

std::vector<std::string> tell(const Under& under, const Trajectory& keyframes, double first) {
  std::vector<std::string> lines;
  if (const auto& s = under.surface) {
    const Eigen::Vector3d &p = s->point, &n = s->normal;
    lines.push_back(fmt::format("at {:.3f}, {:.3f}, {:.3f} m", p.x(), p.y(), p.z()));
    lines.push_back("depth " + format_length(s->depth) +
                    (s->sigma ? " \u00b1 " + format_length(*s->sigma) : ""));
    lines.push_back(fmt::format("normal {:.2f}, {:.2f}, {:.2f}", n.x(), n.y(), n.z()));
    lines.push_back(fmt::format("Gaussian {}", s->gaussian));
  }
  if (under.keyframe) {
    const auto index = static_cast<std::size_t>(under.keyframe->index);
    std::string line =
        fmt::format("{} {}", under.keyframe->pointed ? "keyframe" : "seen best by keyframe", index);
    if (index < keyframes.size()) line += " at " + format_time(keyframes[index].timestamp - first);
    lines.push_back(line);
  }
  if (lines.empty()) lines.emplace_back("nothing");
  return lines;
}

std::string describe_distance(const Pick& from, const Pick& to) {
  return fmt::format("distance={:.4f} from={} to={}", (to.point - from.point).norm(), vector_text(from.point),
                     vector_text(to.point));
}

void add_mark(std::vector<Line>& lines, const Pick& pick, const Camera& camera, double pixels) {
  const double depth = (camera.world_to_camera * pick.point).z();
  const double half = 0.5 * pixels * depth / camera.intrinsics.fx;
  const Eigen::Matrix3d axes = camera.world_to_camera.linear().transpose();
  for (int i = 0; i < 2; ++i)
    add_link(lines, pick.point - half * axes.col(i), pick.point + half * axes.col(i), {kMark, 2, true});
}

void add_normal(std::vector<Line>& lines, const Pick& pick, const Camera& camera, double pixels) {
  const double length = pixels * pick.depth / camera.intrinsics.fx;
  add_link(lines, pick.point, pick.point + length * pick.normal, {kNormal, 2, true});
}

void add_ruler(std::vector<Line>& lines, std::span<const Pick> ends, const Camera& camera) {
  for (const Pick& end : ends) add_mark(lines, end, camera, kMarkPixels);
  if (ends.size() == 2) add_link(lines, ends[0].point, ends[1].point, {kMark, 2, true});
}

}  // namespace surefield
