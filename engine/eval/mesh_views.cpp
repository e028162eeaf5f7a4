#include "engine/eval/mesh_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace surefield {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

constexpr double kNear = 0.01;          // metres
constexpr double kTolerance = 0.03;     // metres behind the truth that still count as seen
constexpr double kLongestSide = 0.025;  // metres; of the triangles that are kept or culled as a whole
constexpr float kNothing = std::numeric_limits<float>::infinity();

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::size_t pixel(const Intrinsics& k, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(k.width) + static_cast<std::size_t>(u);
}

/// Draws triangles into a depth image.
class DepthBuffer {
 public:
  explicit DepthBuffer(const Intrinsics& intrinsics)
      : k_(intrinsics), depth_(pixel(intrinsics, 0, intrinsics.height), kNothing) {}

  /// Corners in the camera's frame. What lies before the near plane is cut off.
  void draw(const Corners& triangle) {
    std::array<Vector3d, 4> polygon;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& a = triangle[i];
      const Vector3d& b = triangle[(i + 1) % 3];
      if (a.z() >= kNear) polygon[count++] = a;
      if ((a.z() >= kNear) != (b.z() >= kNear)) {
        polygon[count++] = a + (b - a) * ((kNear - a.z()) / (b.z() - a.z()));
      }
    }
    for (std::size_t i = 2; i < count; ++i) fill({polygon[0], polygon[i - 1], polygon[i]});
  }

  std::vector<float> take() { return std::move(depth_); }

 private:
  void fill(const Corners& c) {
    std::array<Vector2d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = {k_.fx * c[i].x() / c[i].z() + k_.cx, k_.fy * c[i].y() / c[i].z() + k_.cy};
    }
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    if (area == 0) return;
    const Vector2d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
    const Vector2d high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const int last_u = static_cast<int>(std::floor(std::min(high.x(), k_.width - 1.0)));
    const int last_v = static_cast<int>(std::floor(std::min(high.y(), k_.height - 1.0)));
    for (int v = static_cast<int>(std::ceil(std::clamp(low.y(), 0.0, 1.0 * k_.height))); v <= last_v; ++v) {
      for (int u = static_cast<int>(std::ceil(std::clamp(low.x(), 0.0, 1.0 * k_.width))); u <= last_u; ++u) {
        const Vector2d at(u, v);
        const double b0 = cross(p[1] - at, p[2] - at) / area;
        const double b1 = cross(p[2] - at, p[0] - at) / area;
        const double b2 = 1 - b0 - b1;
        if (b0 < 0 || b1 < 0 || b2 < 0) continue;
        // Inverse depth is linear over the image.
        const double z = 1 / (b0 / c[0].z() + b1 / c[1].z() + b2 / c[2].z());
        float& nearest = depth_[pixel(k_, u, v)];
        nearest = std::min(nearest, static_cast<float>(z));
      }
    }
  }

  Intrinsics k_;
  std::vector<float> depth_;
};

/// Calls `use` for the pieces of a triangle, halved across the longest side until that is short enough.
template <typename Use>
void cut(const Corners& triangle, Use& use) {
  const auto side = [&](std::size_t i) { return (triangle[(i + 1) % 3] - triangle[i]).squaredNorm(); };
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (side(i) > side(longest)) longest = i;
  }
  if (side(longest) <= kLongestSide * kLongestSide) {
    use(triangle);
    return;
  }
  const Vector3d& a = triangle[longest];
  const Vector3d& b = triangle[(longest + 1) % 3];
  const Vector3d& c = triangle[(longest + 2) % 3];
  const Vector3d middle = (a + b) / 2;
  cut({a, middle, c}, use);
  cut({middle, b, c}, use);
}

Corners corners_of(const TriangleMesh& mesh, const std::array<uint32_t, 3>& triangle) {
  return {mesh.vertices[triangle[0]].cast<double>(), mesh.vertices[triangle[1]].cast<double>(),
          mesh.vertices[triangle[2]].cast<double>()};
}

}  // namespace

std::vector<float> render_mesh_depth(const TriangleMesh& mesh, const Camera& camera) {
  DepthBuffer buffer(camera.intrinsics);
  std::vector<Vector3d> seen;
  seen.reserve(mesh.vertices.size());
  for (const auto& vertex : mesh.vertices) seen.push_back(camera.world_to_camera * vertex.cast<double>());
  for (const auto& t : mesh.triangles) buffer.draw({seen[t[0]], seen[t[1]], seen[t[2]]});
  return buffer.take();
}

MeshViews::MeshViews(const TriangleMesh& truth, const std::vector<Camera>& cameras) {
  for (const Camera& camera : cameras) views_.push_back({camera, render_mesh_depth(truth, camera)});
}

bool MeshViews::sees(const Vector3d& point) const {
  return std::any_of(views_.begin(), views_.end(), [&](const View& view) { return sees(view, point); });
}

bool MeshViews::sees(const View& view, const Vector3d& point) {
  const Intrinsics& k = view.camera.intrinsics;
  const Vector3d p = view.camera.world_to_camera * point;
  if (p.z() < kNear) return false;
  const double u = k.fx * p.x() / p.z() + k.cx;
  const double v = k.fy * p.y() / p.z() + k.cy;
  if (!(u >= -0.5 && v >= -0.5 && u < k.width - 0.5 && v < k.height - 0.5)) return false;
  float farthest = 0;
  for (int i = 0; i < 4; ++i) {
    const int column = std::clamp(static_cast<int>(std::floor(u)) + (i & 1), 0, k.width - 1);
    const int row = std::clamp(static_cast<int>(std::floor(v)) + (i >> 1), 0, k.height - 1);
    farthest = std::max(farthest, view.depth[pixel(k, column, row)]);
  }
  return p.z() <= farthest + kTolerance;
}

TriangleMesh MeshViews::visible_part(const TriangleMesh& mesh) const {
  TriangleMesh visible;
  auto keep_seen = [&](const Corners& piece) {
    if (!sees((piece[0] + piece[1] + piece[2]) / 3)) return;
    const auto first = static_cast<uint32_t>(visible.vertices.size());
    for (const Vector3d& corner : piece) visible.vertices.push_back(corner.cast<float>());
    visible.triangles.push_back({first, first + 1, first + 2});
  };
  for (const auto& t : mesh.triangles) cut(corners_of(mesh, t), keep_seen);
  return visible;
}

DepthDifference MeshViews::compare_depth(const TriangleMesh& mesh) const {
  double sum = 0;
  double both = 0;
  double truth = 0;
  for (const View& view : views_) {
    const std::vector<float> depth = render_mesh_depth(mesh, view.camera);
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (view.depth[i] == kNothing) continue;
      ++truth;
      if (depth[i] == kNothing) continue;
      ++both;
      sum += std::abs(static_cast<double>(depth[i]) - static_cast<double>(view.depth[i]));
    }
  }
  if (both == 0) return {std::numeric_limits<double>::quiet_NaN(), 0};
  return {sum / both, both / truth};
}

}  // namespace surefield
