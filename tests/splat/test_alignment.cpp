#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "engine/gpu/recorder.h"
#include "engine/splat/rasteriser.h"
#include "engine/types/depth_noise.h"
#include "shaders/shared/align_step.h"
#include "shaders/shared/align_sums.h"
#include "tests/splat/compare.h"
#include "tests/splat/on_device.h"
#include "tests/support/device.h"

// The passes of Gauss-Newton tracking one by one, against double precision.

using namespace surefield;
using testing::largest_difference;
using testing::magnitude;
using testing::on_device;

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kVarianceColour = 0.01, kVarianceDepth = 40;
constexpr glsl::AlignScales kScales{static_cast<float>(kVarianceColour), static_cast<float>(kVarianceDepth)};
constexpr double kFreedom = 5;
constexpr double kBalance = 0.3;
const DepthNoise kNoise{0.002, 0.001, 0.003};

Eigen::Vector3d to_eigen(const glsl::vec3& v) {
  return {v.x, v.y, v.z};
}

/// Exp(phi) and tau of xi = (tau, phi), which move a point in the camera frame.
Pose small_motion(const Vector6& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  Pose pose = Pose::Identity();
  if (phi.norm() > 0) pose.linear() = Eigen::AngleAxisd(phi.norm(), phi.normalized()).toRotationMatrix();
  pose.translation() = xi.head<3>();
  return pose;
}

/// A render and a frame of `width` x `height` with wavy intensity and depth, some of it missing.
struct Pair {
  int width, height;
  Intrinsics intrinsics;
  std::vector<glsl::AlignPoint> points;
  std::vector<glsl::vec2> sensor;
};

Pair make_pair(int width, int height) {
  Pair pair{width, height, {.width = width, .height = height, .fx = 60, .fy = 64}, {}, {}};
  pair.intrinsics.cx = 0.5 * width - 0.3;
  pair.intrinsics.cy = 0.5 * height + 0.2;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> noise(-0.02f, 0.02f);
  for (int i = 0; i < width * height; ++i) {
    const auto u = static_cast<float>(i % width), v = static_cast<float>(i / width);
    const float intensity = 0.5f + 0.3f * std::sin(0.4f * u) * std::cos(0.3f * v);
    const float depth = 2 + 0.3f * std::sin(0.2f * u + 0.1f * v);
    const Eigen::Vector3f normal =
        Eigen::Vector3f(std::sin(0.1f * u), 0.3f * std::cos(0.2f * v), -1).normalized();
    pair.points.push_back({intensity, i % 13 == 5 ? 0 : depth, {normal.x(), normal.y(), normal.z()}});
    if (i % 17 == 3) pair.points.back().normal = {0, 0, 0};
    if (i % 19 == 6) pair.points.back() = {intensity, -1.5f, {0, 0, 0}};  // not measured
    // One in eleven measures another surface, or nothing.
    const float measured = i % 11 == 4 ? 0 : i % 11 == 8 ? 2 * depth : depth + noise(random);
    pair.sensor.push_back({intensity + noise(random), measured});
  }
  return pair;
}

/// Both residuals of one point, that of depth in deviations of the sensor, after a further motion and with
/// the point `deeper` metres down its ray; lookup happens for the pose without them.
struct Residuals {
  bool visible = false, measured = false;
  bool hidden = false;  ///< the frame shows another surface there
  double colour = 0, depth = 0;
};

Residuals residuals_of(const Pair& p, int i, const Pose& pose, const Vector6& xi, double deeper = 0) {
  const Intrinsics& k = p.intrinsics;
  const glsl::AlignPoint& point = p.points[i];
  if (point.depth == 0) return {};
  const double depth = std::abs(point.depth);
  const Eigen::Vector3d ray((i % p.width - k.cx) / k.fx, (i / p.width - k.cy) / k.fy, 1);
  const Eigen::Vector3d Y0 = pose * (depth * ray), Y = small_motion(xi) * (pose * ((depth + deeper) * ray));
  const double u0 = k.fx * Y0.x() / Y0.z() + k.cx, v0 = k.fy * Y0.y() / Y0.z() + k.cy;
  if (u0 < 0 || v0 < 0 || u0 >= p.width - 1 || v0 >= p.height - 1) return {};
  const int column = static_cast<int>(u0), row = static_cast<int>(v0);
  const double a = k.fx * Y.x() / Y.z() + k.cx - column, b = k.fy * Y.y() / Y.z() + k.cy - row;
  const auto sensor = [&](int x, int y) { return p.sensor[(row + y) * p.width + column + x]; };
  Residuals r{.visible = true};
  r.colour = (1 - a) * (1 - b) * sensor(0, 0).x + a * (1 - b) * sensor(1, 0).x +
             (1 - a) * b * sensor(0, 1).x + a * b * sensor(1, 1).x - point.intensity;

  const int right = u0 - column >= 0.5, lower = v0 - row >= 0.5;
  const double seen = sensor(right, lower).y;
  r.hidden = point.depth > 0 && seen > 0 && std::abs(seen - Y0.z()) >= 0.05 * Y0.z();
  const Eigen::Vector3d n = to_eigen(point.normal);
  r.measured = seen > 0 && std::abs(seen - Y0.z()) < 0.2 * Y0.z() && n.norm() > 0;
  if (!r.measured) return r;
  const Eigen::Vector3d S(seen * (column + right - k.cx) / k.fx, seen * (row + lower - k.cy) / k.fy, seen);
  // The division by the deviation is a weight, held fixed.
  r.depth = (small_motion(xi).rotation() * pose.rotation() * n).dot(Y - S) / kNoise.sigma(Y0.z());
  return r;
}

double weight_of(double residual, double variance) {
  return (kFreedom + 1) / (kFreedom + residual * residual / variance);
}

struct Sums {
  Matrix6 normal = Matrix6::Zero();
  Vector6 slope = Vector6::Zero();
  double squares_colour = 0, squares_depth = 0, pixels_colour = 0, pixels_depth = 0;
};

constexpr double kStep = 1e-6;

bool inside(const Pair& p, int column, int row) {
  return column > 0 && row > 0 && column + 1 < p.width && row + 1 < p.height;
}

Eigen::Vector3d ray_of(const Pair& p, int column, int row) {
  const Intrinsics& k = p.intrinsics;
  return {(column - k.cx) / k.fx, (row - k.cy) / k.fy, 1};
}

/// The derivative of the photometric residual as the points tell it: how their own image changes around point
/// i where it moves as the camera does.
Vector6 colour_by_points(const Pair& p, int i, const Pose& pose) {
  const Intrinsics& k = p.intrinsics;
  const int column = i % p.width, row = i / p.width;
  if (!inside(p, column, row)) return Vector6::Zero();
  const auto at = [&](int x, int y) {
    return static_cast<double>(p.points[(row + y) * p.width + column + x].intensity);
  };
  const Eigen::Vector3d Y = pose * (std::abs(p.points[i].depth) * ray_of(p, column, row));
  const auto intensity = [&](const Vector6& xi) {
    const Eigen::Vector3d P = pose.inverse() * (small_motion(xi) * Y);
    const double u = k.fx * P.x() / P.z() + k.cx - column, v = k.fy * P.y() / P.z() + k.cy - row;
    return u * (at(1, 0) - at(-1, 0)) / 2 + v * (at(0, 1) - at(0, -1)) / 2;
  };
  return Vector6::NullaryExpr([&](Eigen::Index n) {
    return (intensity(kStep * Vector6::Unit(n)) - intensity(-kStep * Vector6::Unit(n))) / (2 * kStep);
  });
}

/// The derivative of the geometric residual as the frame tells it: with the normal of the plane on which the
/// inverse depths of the frame's four neighbours lie, as long as the distance of the plane is the points'.
Vector6 depth_by_frame(const Pair& p, int i, const Pose& pose) {
  const Intrinsics& k = p.intrinsics;
  const Eigen::Vector3d Y = pose * (std::abs(p.points[i].depth) * ray_of(p, i % p.width, i / p.width));
  const double u = k.fx * Y.x() / Y.z() + k.cx, v = k.fy * Y.y() / Y.z() + k.cy;
  const int column = static_cast<int>(std::floor(u + 0.5)), row = static_cast<int>(std::floor(v + 0.5));
  if (!inside(p, column, row)) return Vector6::Zero();
  const auto depth = [&](int x, int y) {
    return static_cast<double>(p.sensor[(row + y) * p.width + column + x].y);
  };
  for (const auto& [x, y] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
    if (!(depth(x, y) > 0) || std::abs(depth(x, y) - depth(0, 0)) > 0.05 * depth(0, 0))
      return Vector6::Zero();
  Eigen::Matrix3d rays;
  rays << (ray_of(p, column + 1, row) - ray_of(p, column - 1, row)).transpose(),
      (ray_of(p, column, row + 1) - ray_of(p, column, row - 1)).transpose(),
      ray_of(p, column, row).transpose();
  const Eigen::Vector3d plane = rays.lu().solve(Eigen::Vector3d(
      1 / depth(1, 0) - 1 / depth(-1, 0), 1 / depth(0, 1) - 1 / depth(0, -1), 1 / depth(0, 0)));
  const Eigen::Vector3d S = depth(0, 0) * ray_of(p, column, row);
  const Eigen::Vector3d m = pose.rotation() * to_eigen(p.points[i].normal);
  const Eigen::Vector3d n = m.dot(S) * plane;
  return Vector6::NullaryExpr([&](Eigen::Index axis) {
    const auto distance = [&](double step) {
      const Pose motion = small_motion(step * Vector6::Unit(axis));
      return (motion.rotation() * n).dot(motion * Y - S) / kNoise.sigma(Y.z());
    };
    return (distance(kStep) - distance(-kStep)) / (2 * kStep);
  });
}

/// The product of both, with both orders alike.
Matrix6 crossed(const Vector6& one, const Vector6& other) {
  return (one * other.transpose() + other * one.transpose()) / 2;
}

/// The oracle, over every `stride`-th pixel: every derivative is a central difference. What a keyframe saw
/// and the frame does not takes no part in the photometric term. `evidence`: each product of derivatives has
/// one from the frame and one from the points.
Sums reference_sums(const Pair& p, const Pose& pose, int stride, bool from_keyframe, bool evidence) {
  Sums s;
  for (int i = 0; i < p.width * p.height; i += stride) {
    const Residuals r = residuals_of(p, i, pose, Vector6::Zero());
    if (!r.visible) continue;
    Vector6 J_colour, J_depth;
    for (int k = 0; k < 6; ++k) {
      const Residuals more = residuals_of(p, i, pose, kStep * Vector6::Unit(k));
      const Residuals less = residuals_of(p, i, pose, -kStep * Vector6::Unit(k));
      J_colour[k] = (more.colour - less.colour) / (2 * kStep);
      J_depth[k] = (more.depth - less.depth) / (2 * kStep);
    }
    if (!from_keyframe || !r.hidden) {
      // An uncertain depth adds to the variance of the intensity; the residual's weight and square shrink by
      // that.
      const Residuals more = residuals_of(p, i, pose, Vector6::Zero(), kStep);
      const Residuals less = residuals_of(p, i, pose, Vector6::Zero(), -kStep);
      const double by_depth = (more.colour - less.colour) / (2 * kStep) *
                              (p.points[i].depth > 0 ? kNoise.sigma(p.points[i].depth) : -p.points[i].depth);
      const double certainty = kVarianceColour / (kVarianceColour + by_depth * by_depth);
      const double w = certainty * weight_of(std::sqrt(certainty) * r.colour, kVarianceColour);
      s.squares_colour += w * r.colour * r.colour;
      s.pixels_colour += 1;
      const Vector6 other = evidence ? colour_by_points(p, i, pose) : J_colour;
      s.normal += w / kVarianceColour * crossed(J_colour, other);
      s.slope += w / kVarianceColour * r.colour * J_colour;
    }
    if (!r.measured) continue;
    const double v = weight_of(r.depth, kVarianceDepth);
    s.squares_depth += v * r.depth * r.depth;
    s.pixels_depth += 1;
    const Vector6 other = evidence ? depth_by_frame(p, i, pose) : J_depth;
    s.normal += kBalance * v / kVarianceDepth * crossed(J_depth, other);
    s.slope += kBalance * v / kVarianceDepth * r.depth * J_depth;
  }
  return s;
}

glsl::CameraState camera_state(const Intrinsics& intrinsics) {
  return to_device(Camera{intrinsics});
}

glsl::AlignState state_of(const Pair& p, const Pose& motion) {
  const glsl::CameraState moved = to_device(Camera{p.intrinsics, motion});
  return {.base = camera_state(p.intrinsics),
          .rotation0 = moved.rotation0,
          .rotation1 = moved.rotation1,
          .rotation2 = moved.rotation2,
          .translation = moved.translation,
          .scales = {kScales, kScales, kScales}};
}

Pose some_motion() {
  return small_motion((Vector6() << 0.02, -0.03, 0.01, 0.01, 0.02, -0.015).finished());
}

Sums add_up(const std::vector<glsl::AlignSums>& partial) {
  Sums s;
  for (const glsl::AlignSums& part : partial) {
    int at = 0;
    for (int row = 0; row < 6; ++row) {
      s.slope[row] += part.slope[row];
      for (int column = row; column < 6; ++column) {
        s.normal(row, column) += part.normal[at];
        if (column > row) s.normal(column, row) += part.normal[at];
        ++at;
      }
    }
    s.squares_colour += part.squares_colour;
    s.squares_depth += part.squares_depth;
    s.pixels_colour += part.pixels_colour;
    s.pixels_depth += part.pixels_depth;
  }
  return s;
}

template <class Matrix>
std::vector<double> entries(const Matrix& m) {
  return {m.data(), m.data() + m.size()};
}

}  // namespace

namespace {

/// A call of align_sums: the motion is that of the render's points, or composed of the motion, the base and
/// the keyframe's camera.
struct SumsCase {
  int width, height, stride;
  bool from_keyframe = false;
  bool evidence = false;
};

void check_sums(const SumsCase& size) {
  gpu::Device& device = testing::device();
  const gpu::Pass<passes::align_sums> pass(device, 64,
                                           {.FROM_KEYFRAME = size.from_keyframe, .CROSSED = size.evidence});
  const Pair p = make_pair(size.width, size.height);
  const auto strips = static_cast<uint32_t>(p.points.size() / (size.stride * glsl::ALIGN_STRIP) + 1);
  const Pose base = small_motion(Vector6::Constant(0.3)),
             keyframe = small_motion(Vector6::Constant(0.01)) * base;
  glsl::AlignState host_state = state_of(p, some_motion());
  if (size.from_keyframe) {
    host_state.base = to_device(Camera{p.intrinsics, base});
    host_state.references[1] = to_device(Camera{p.intrinsics, keyframe});
  }
  const Pose pose = size.from_keyframe ? some_motion() * base * keyframe.inverse() : some_motion();
  const auto state = on_device("state", std::vector{host_state});
  const auto points = on_device("points", p.points);
  const auto sensor = on_device("sensor", p.sensor);
  const uint32_t count = pass.groups(strips) * (64 / device.limits().subgroup_size);
  constexpr uint32_t kFirst = 3;
  const gpu::Array<glsl::AlignSums> partial(device, "partial sums", kFirst + count);
  gpu::Recorder recorder(device);
  recorder.dispatch(pass, pass.groups(strips),
                    {.state = state, .points = points, .sensor = sensor, .partial_sums = partial},
                    {.width = static_cast<uint32_t>(p.width),
                     .height = static_cast<uint32_t>(p.height),
                     .level = 0,
                     .strips = strips,
                     .stride = static_cast<uint32_t>(size.stride),
                     .weight = 0.5f,
                     .balance = static_cast<float>(kBalance),
                     .source = size.from_keyframe ? 2u : 0u,
                     .first = kFirst,
                     .noise = {static_cast<float>(kNoise.constant), static_cast<float>(kNoise.linear),
                               static_cast<float>(kNoise.quadratic)}});
  recorder.submit();
  const auto written = partial.download(kFirst + count);
  const Sums got = add_up({written.begin() + kFirst, written.end()});
  Sums want = reference_sums(p, pose, size.stride, size.from_keyframe, size.evidence);
  want.normal *= 0.5;
  want.slope *= 0.5;
  CHECK(got.pixels_colour == want.pixels_colour);
  CHECK(got.pixels_depth == want.pixels_depth);
  CHECK(got.squares_colour == doctest::Approx(want.squares_colour).epsilon(1e-3));
  CHECK(got.squares_depth == doctest::Approx(want.squares_depth).epsilon(1e-3));
  CHECK(largest_difference(entries(got.normal), entries(want.normal), magnitude(entries(want.normal))) <
        1e-3);
  CHECK(largest_difference(entries(got.slope), entries(want.slope), magnitude(entries(want.slope))) < 1e-3);
}

}  // namespace

TEST_CASE("the sums of a Gauss-Newton step agree with differences of the residuals") {
  for (SumsCase size : {SumsCase{2, 2, 1},
                        {2, 2, 3},
                        {3, 3, 1},
                        {7, 5, 1},
                        {64, 48, 1},
                        {83, 61, 1},
                        {83, 61, 3},
                        {64, 48, 4}}) {
    for (const bool from_keyframe : {false, true})
      for (const bool evidence : {false, true}) {
        CAPTURE(size.width);
        CAPTURE(size.stride);
        CAPTURE(from_keyframe);
        CAPTURE(evidence);
        size.from_keyframe = from_keyframe;
        size.evidence = evidence;
        check_sums(size);
      }
  }
}

TEST_CASE("a Gauss-Newton step adds up its sources and scales the residuals of each by its own") {
  gpu::Device& device = testing::device();
  const gpu::Pass<passes::align_step> pass(device, 64);
  constexpr uint32_t kCount = 70;
  const Pair p = make_pair(8, 8);
  std::vector<glsl::AlignSums> partial(3 * kCount);
  for (uint32_t i = 0; i < partial.size(); ++i) {
    glsl::AlignSums& part = partial[i];
    int at = 0;
    for (int row = 0; row < 6; ++row) {
      part.slope[row] = 0.01f * static_cast<float>(row + i / kCount);
      for (int column = row; column < 6; ++column)
        part.normal[at++] = row == column ? 1.0f + static_cast<float>(i / kCount) : 0.1f;
    }
    part.squares_colour = 0.01f * static_cast<float>(1 + i / kCount);
    part.pixels_colour = 1;
  }
  const Sums sum = add_up(partial);
  Matrix6 H = sum.normal;
  H.diagonal() *= 1 + 1e-4;
  const Vector6 xi = -H.ldlt().solve(sum.slope);
  const auto status = on_device("status", std::vector<glsl::RenderStatus>{{}});
  const auto state = on_device("state", std::vector{state_of(p, Pose::Identity())});
  const auto camera = on_device("camera", std::vector{camera_state(p.intrinsics)});
  const auto sums = on_device("sums", partial);
  gpu::Recorder recorder(device);
  recorder.dispatch(pass, 1,
                    {.status = status, .partial_sums = gpu::as_words(sums), .state = state, .camera = camera},
                    {.count = kCount, .sources = 3});
  recorder.submit();
  CHECK((pose_of(camera.download(1)[0]).matrix() - small_motion(xi).matrix()).norm() < 1e-5);
  for (int source = 0; source < 3; ++source)
    CHECK(state.download(1)[0].scales[source].colour == doctest::Approx(0.01 * (1 + source)));

  // A keyframe alone: its sums come first, and the scales of the render stay.
  recorder.dispatch(pass, 1,
                    {.status = status, .partial_sums = gpu::as_words(sums), .state = state, .camera = camera},
                    {.count = kCount, .first_source = 2, .sources = 1});
  recorder.submit();
  for (int source = 0; source < 3; ++source)
    CHECK(state.download(1)[0].scales[source].colour == doctest::Approx(source == 1 ? 0.02 : 0.01));
}

TEST_CASE(
    "a Gauss-Newton step solves the normal equations and moves the camera; none where they are singular") {
  gpu::Device& device = testing::device();
  const gpu::Pass<passes::align_step> pass(device, 64);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const uint32_t count : {1u, 63u, 64u, 65u, 300u}) {
    CAPTURE(count);
    const Pair p = make_pair(8, 8);
    std::vector<glsl::AlignSums> partial(count);
    for (glsl::AlignSums& part : partial) {
      const Matrix6 A = Matrix6::NullaryExpr([&] { return uniform(random); });
      const Matrix6 H = A * A.transpose() + 0.5 * Matrix6::Identity();
      int at = 0;
      for (int row = 0; row < 6; ++row) {
        part.slope[row] = static_cast<float>(0.05 * uniform(random));
        for (int column = row; column < 6; ++column) part.normal[at++] = static_cast<float>(H(row, column));
      }
      part.squares_colour = 0.02f;
      part.pixels_colour = 2;
    }
    Matrix6 H = add_up(partial).normal;
    H.diagonal() *= 1 + 1e-4;
    const Vector6 xi = -H.ldlt().solve(add_up(partial).slope);

    const gpu::Array<glsl::RenderStatus> status = on_device("status", std::vector<glsl::RenderStatus>{{}});
    const auto step = [&](const std::vector<glsl::AlignSums>& sums) {
      const Camera base{p.intrinsics, small_motion(Vector6::Constant(0.3))};
      glsl::AlignState before = state_of(p, some_motion());
      before.base = to_device(base);
      before.scales[1].depth = 0.5f;  // of a source that is not there
      const auto state = on_device("state", std::vector{before});
      const auto camera = on_device("camera", std::vector{before.base});
      const auto device_sums = on_device("sums", sums);
      gpu::Recorder recorder(device);
      recorder.dispatch(
          pass, 1,
          {.status = status, .partial_sums = gpu::as_words(device_sums), .state = state, .camera = camera},
          {.count = count, .sources = 1});
      recorder.submit();
      const glsl::AlignState after = state.download(1)[0];
      CHECK(after.scales[0].colour == doctest::Approx(sums[0].pixels_colour > 0 ? 0.01 : kVarianceColour));
      CHECK(after.scales[1].depth == 0.5f);
      return (pose_of(camera.download(1)[0]) * base.world_to_camera.inverse()).matrix().eval();
    };
    const Pose want = small_motion(xi) * some_motion();
    CHECK((step(partial) - want.matrix()).norm() < 1e-5);
    CHECK((step(std::vector<glsl::AlignSums>(count)) - Pose::Identity().matrix()).norm() < 1e-6);
  }
}
