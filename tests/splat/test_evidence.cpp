// What tracking says of its result: what the map explains of a frame, and how certain the pose is.
#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <random>

#include "engine/gpu/recorder.h"
#include "engine/splat/adam_tracker.h"
#include "engine/splat/gauss_newton_tracker.h"
#include "engine/splat/pose_evidence.h"
#include "engine/types/depth_noise.h"
#include "tests/splat/on_device.h"
#include "tests/splat/wall.h"

using namespace surefield;
using testing::on_device;

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

std::mt19937& generator() {
  static std::mt19937 random(11);
  return random;
}

double uniform(double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(generator());
}

/// A render and a frame of so many pixels.
struct Pixels {
  std::vector<glsl::vec4> colour_opacity, geometry;
  std::vector<glsl::uint> colour;
  std::vector<float> depth;
};

Pixels make_pixels(std::size_t count) {
  Pixels p;
  for (std::size_t i = 0; i < count; ++i) {
    const auto opacity = static_cast<float>(uniform(0, 1)), z = static_cast<float>(uniform(0.5, 8));
    p.colour_opacity.push_back({0.2f, 0.4f, 0.6f, opacity});
    p.geometry.push_back({opacity * z, 0, 0, 0});
    p.colour.push_back(0xff804020u);
    p.depth.push_back(i % 7 == 3 ? 0 : z + static_cast<float>(uniform(-0.2, 0.3)));
  }
  return p;
}

const DepthNoise kNoise{0.002, 0.001, 0.003};
constexpr double kLeastOpacity = 0.4;

struct Counts {
  uint32_t explained = 0, through = 0;
};

/// The oracle; `near` counts what is too near a limit for single precision to tell.
Counts reference_counts(const Pixels& p, uint32_t& near) {
  Counts counts;
  for (std::size_t i = 0; i < p.depth.size(); ++i) {
    const double opacity = p.colour_opacity[i].w, sensor = p.depth[i];
    if (!(opacity > kLeastOpacity) || !(sensor > 0)) continue;
    const double off = sensor - static_cast<double>(p.geometry[i].x) / opacity;
    const double explained = std::max(3 * kNoise.sigma(sensor), 0.02);
    const double through = std::max(3 * kNoise.sigma(sensor), 0.05);
    counts.explained += std::abs(off) < explained;
    counts.through += off > through;
    near += std::abs(std::abs(off) - explained) < 1e-5 || std::abs(off - through) < 1e-5;
  }
  return counts;
}

glsl::AlignSums random_sums() {
  glsl::AlignSums sums{};
  const Matrix6 A = Matrix6::NullaryExpr([] { return uniform(-1, 1); });
  const Matrix6 H = A * A.transpose() + 0.5 * Matrix6::Identity();
  int at = 0;
  for (int row = 0; row < 6; ++row) {
    sums.slope[row] = static_cast<float>(uniform(-0.1, 0.1));
    for (int column = row; column < 6; ++column) sums.normal[at++] = static_cast<float>(H(row, column));
  }
  return sums;
}

Matrix6 normal_of(const glsl::AlignSums& sums) {
  Matrix6 H;
  int at = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) H(row, column) = H(column, row) = sums.normal[at++];
  return H;
}

Vector6 slope_of(const glsl::AlignSums& sums) {
  return Vector6::NullaryExpr([&](Eigen::Index row) { return static_cast<double>(sums.slope[row]); });
}

}  // namespace

TEST_CASE("the pixels that the render explains, and those that see through it, are counted") {
  gpu::Device& device = testing::device();
  const gpu::Pass<passes::track_residuals> pass(device, 64, {.NORMALISED_DEPTH = 1});
  for (const uint32_t count : {1u, 63u, 65u, 4097u}) {
    CAPTURE(count);
    const Pixels p = make_pixels(count);
    const auto histograms = on_device("histograms", std::vector<glsl::uint>(glsl::RESIDUAL_COUNTS));
    const gpu::Array<glsl::vec2> residuals(device, "residuals", count);
    const auto colour_opacity = on_device("render", p.colour_opacity);
    const auto geometry = on_device("geometry", p.geometry);
    const auto colour = on_device("colour", p.colour);
    const auto depth = on_device("depth", p.depth);
    gpu::Recorder recorder(device);
    recorder.dispatch(pass, pass.groups(count),
                      {.colour_opacity = colour_opacity,
                       .geometry = geometry,
                       .sensor_colour = colour,
                       .sensor_depth = depth,
                       .residuals = residuals,
                       .histograms = histograms},
                      {.pixels = count,
                       .minimum_opacity = static_cast<float>(kLeastOpacity),
                       .noise = {static_cast<float>(kNoise.constant), static_cast<float>(kNoise.linear),
                                 static_cast<float>(kNoise.quadratic)}});
    recorder.submit();
    uint32_t near = 0;
    const Counts want = reference_counts(p, near);
    REQUIRE(near == 0);
    const auto got = histograms.download(glsl::RESIDUAL_COUNTS);
    CHECK(got[glsl::RESIDUAL_EXPLAINED] == want.explained);
    CHECK(got[glsl::RESIDUAL_THROUGH] == want.through);
  }
}

TEST_CASE("the evidence of each part is the sum of its partial sums") {
  gpu::Device& device = testing::device();
  const gpu::Pass<passes::align_evidence> pass(device, 64);
  for (const uint32_t count : {1u, 64u, 65u, 200u}) {
    CAPTURE(count);
    constexpr uint32_t kParts = 3;
    std::vector<glsl::AlignSums> partial;
    for (uint32_t i = 0; i < kParts * count; ++i) partial.push_back(random_sums());
    const auto sums = on_device("sums", partial);
    const gpu::Array<glsl::AlignSums> evidence(device, "evidence", kParts);
    gpu::Recorder recorder(device);
    recorder.dispatch(pass, 1, {.partial_sums = gpu::as_words(sums), .evidence = gpu::as_words(evidence)},
                      {.count = count, .parts = kParts});
    recorder.submit();
    const auto got = evidence.download(kParts);
    for (uint32_t part = 0; part < kParts; ++part) {
      Matrix6 H = Matrix6::Zero();
      Vector6 b = Vector6::Zero();
      for (uint32_t i = part * count; i < (part + 1) * count; ++i) {
        H += normal_of(partial[i]);
        b += slope_of(partial[i]);
      }
      CHECK((normal_of(got[part]) - H).norm() < 1e-5 * H.norm());
      CHECK((slope_of(got[part]) - b).norm() < 1e-4 * std::sqrt(count));
    }
  }
}

TEST_CASE("evidence adds up what its parts know, and measures how they disagree") {
  // Two sources, of which the second parts say what the photometric term does.
  std::vector<glsl::AlignSums> parts;
  for (int source = 0; source < 2; ++source) {
    const glsl::AlignSums colour = random_sums(), depth = random_sums();
    glsl::AlignSums all = colour;
    for (int n = 0; n < 21; ++n) all.normal[n] += depth.normal[n];
    for (int n = 0; n < 6; ++n) all.slope[n] += depth.slope[n];
    parts.insert(parts.end(), {all, colour});
  }
  constexpr double kThinned = 2;
  const PoseEvidence evidence = evidence_of(parts, kThinned);
  CHECK((evidence.information - kThinned * (normal_of(parts[0]) + normal_of(parts[2]))).norm() < 1e-5);

  // Where each part would put the pose alone, weighed by what it knows, is what disagrees.
  const Vector6 together =
      -evidence.information.ldlt().solve(kThinned * (slope_of(parts[0]) + slope_of(parts[2])));
  Matrix6 want = Matrix6::Zero();
  for (int source = 0; source < 2; ++source) {
    const glsl::AlignSums &all = parts[2 * source], &colour = parts[2 * source + 1];
    const Matrix6 normals[] = {normal_of(colour), normal_of(all) - normal_of(colour)};
    const Vector6 slopes[] = {slope_of(colour), slope_of(all) - slope_of(colour)};
    for (int term = 0; term < 2; ++term) {
      const Vector6 alone = -normals[term].ldlt().solve(slopes[term]);
      const Vector6 pull = kThinned * normals[term] * (together - alone);
      want += pull * pull.transpose();
    }
  }
  CHECK((evidence.disagreement - want).norm() < 1e-4 * want.norm());
}

TEST_CASE("there is no evidence where nothing was seen") {
  const PoseEvidence evidence = evidence_of(std::vector<glsl::AlignSums>(4), 1);
  CHECK(evidence.information.isZero(0));
  CHECK(evidence.disagreement.isZero(0));
}

TEST_CASE("tracking says what the map explains and how certain the pose is") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  TrackingLoss loss(device);
  GaussianMap map(device);
  map.assign(testing::wall(160, 120, 90));
  const Camera camera = testing::wall_camera();
  const testing::Seen seen(rasteriser.render(map, camera));
  const SensorFrame frame(device, seen.view());
  GaussNewtonTracker tracker(device);
  const TrackingResult fits = tracker.track(rasteriser, loss, map, frame, camera, {});
  CHECK(fits.explained > 0.95);
  CHECK(fits.seen_through < 0.01);
  CHECK(
      AdamTracker(device).track(rasteriser, loss, map, frame, camera, {.adam = {.iterations = 2}}).explained >
      0.95);
  CHECK(Eigen::LLT<Matrix6>(fits.evidence.information).info() == Eigen::Success);

  // Where half of the image sees 30 cm through the wall, half is not explained.
  testing::Seen half = seen;
  for (std::size_t i = 0; i < half.depth.size() / 2; ++i)
    if (half.depth[i] > 0) half.depth[i] += 0.3f;
  const SensorFrame other(device, half.view());
  const TrackingResult apart =
      AdamTracker(device).track(rasteriser, loss, map, other, camera,
                                {.adam = {.iterations = 1, .rate_rotation = 0, .rate_translation = 0}});
  CHECK(apart.explained == doctest::Approx(0.5).epsilon(0.1));
  CHECK(apart.seen_through == doctest::Approx(0.5).epsilon(0.1));

  // A wall without texture and relief leaves directions open that the other does not.
  testing::Seen flat = seen;
  std::fill(flat.colour.begin(), flat.colour.end(), uint8_t{128});
  std::fill(flat.depth.begin(), flat.depth.end(), 2.0f);
  const SensorFrame plain(device, flat.view());
  GaussianCloud grey = testing::wall(160, 120, 90);
  for (Eigen::Vector3f& mean : grey.means) mean *= 2 / mean.z();
  std::fill(grey.sh.begin(), grey.sh.end(), 0.0f);
  map.assign(grey);
  const TrackingResult open = tracker.track(rasteriser, loss, map, plain, camera, {});
  const auto least = [](const TrackingResult& r) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(r.evidence.information);
    return solver.eigenvalues().minCoeff() / solver.eigenvalues().maxCoeff();
  };
  CHECK(least(open) < 0.1 * least(fits));
}

namespace {

/// The frame with noise of this size on its colour (of 255) and depth (metres).
testing::Seen noisy(testing::Seen seen, double colour, double depth) {
  std::normal_distribution<double> normal;
  for (uint8_t& value : seen.colour)
    value = static_cast<uint8_t>(std::clamp(std::lround(value + colour * normal(generator())), 0L, 255L));
  for (float& z : seen.depth)
    if (z > 0) z += static_cast<float>(depth * normal(generator()));
  return seen;
}

}  // namespace

TEST_CASE("noise is no evidence: neither as texture nor as relief") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  TrackingLoss loss(device);
  GaussianMap map(device);
  GaussianCloud grey = testing::wall(160, 120, 90);
  for (Eigen::Vector3f& mean : grey.means) mean *= 2 / mean.z();
  std::fill(grey.sh.begin(), grey.sh.end(), 0.0f);
  const Camera camera = testing::wall_camera();
  // What is known of the position along the wall beside what is known of that across it, which depth tells.
  const auto known_along = [&](const GaussianCloud& cloud) {
    map.assign(cloud);
    const testing::Seen seen(rasteriser.render(map, camera));
    GaussNewtonTracker tracker(device);
    const SensorFrame keyframe(device, noisy(seen, 3, 0.005).view());
    tracker.hold(0, 1, keyframe, camera.intrinsics);
    const SensorFrame frame(device, noisy(seen, 3, 0.005).view());
    const TrackingResult result =
        tracker.track(rasteriser, loss, map, frame, camera, {}, std::span(&camera, 1));
    const Matrix6& H = result.evidence.information;
    return std::max(H(0, 0), H(1, 1)) / H(2, 2);
  };
  CHECK(known_along(grey) < 0.02 * known_along(testing::wall(160, 120, 90)));
}
