#include "tests/synth/reference_caster.h"

#include <cmath>
#include <vector>

namespace surefield::testing {

using Eigen::Vector3d;

namespace {

/// The smaller and the larger root of a x^2 + 2 b x + c = 0; none where it has none.
std::vector<double> roots(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant <= 0 || a == 0) return {};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

bool holds(const Shape& shape, const Vector3d& p) {
  constexpr double kSkin = 1e-9;
  const Vector3d u = p.cwiseQuotient(shape.half_size);
  if (shape.kind == ShapeKind::Box) return u.cwiseAbs().maxCoeff() <= 1 + kSkin;
  if (shape.kind == ShapeKind::Ellipsoid) return u.norm() <= 1 + kSkin;
  return u.head<2>().norm() <= 1 + kSkin && std::abs(u.z()) <= 1 + kSkin;
}

/// Where the line o + t d may cross the surface: the planes of the faces and the quadric, each on its own.
std::vector<double> candidates(const Shape& shape, const Vector3d& o, const Vector3d& d) {
  std::vector<double> found;
  for (int axis = shape.kind == ShapeKind::Box ? 0 : 2; axis < 3 && shape.kind != ShapeKind::Ellipsoid;
       ++axis)
    for (const double side : {-1.0, 1.0}) found.push_back((side * shape.half_size[axis] - o[axis]) / d[axis]);
  if (shape.kind == ShapeKind::Box) return found;
  Vector3d uo = o.cwiseQuotient(shape.half_size), ud = d.cwiseQuotient(shape.half_size);
  if (shape.kind == ShapeKind::Cylinder) uo.z() = ud.z() = 0;
  for (const double t : roots(ud.squaredNorm(), uo.dot(ud), uo.squaredNorm() - 1)) found.push_back(t);
  return found;
}

}  // namespace

ReferenceHit reference_cast(const Scene& scene, const Vector3d& origin, const Vector3d& direction) {
  ReferenceHit nearest;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i];
    const Vector3d o = shape.shape_to_world.inverse() * origin;
    const Vector3d d = shape.shape_to_world.linear().transpose() * direction;
    if (holds(shape, o)) continue;
    for (const double t : candidates(shape, o, d)) {
      if (t > 0 && t < nearest.depth && holds(shape, o + t * d)) nearest = {t, static_cast<int>(i)};
    }
  }
  return nearest;
}

Vector3d pixel_ray(const Camera& camera, double u, double v) {
  const Intrinsics& k = camera.intrinsics;
  return camera.world_to_camera.linear().transpose() * Vector3d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
}

}  // namespace surefield::testing
