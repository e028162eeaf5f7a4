#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "engine/splat/map_blocks.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

/// `count` Gaussians, every one turned, those of an anchor after those of another: 0, 1, 2, 3, 0, ...
GaussianCloud scattered(std::size_t count) {
  GaussianCloud cloud;
  cloud.resize(count);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-2, 2);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.means[i] = {uniform(random), uniform(random), uniform(random)};
    cloud.rotations[i] = {1, uniform(random), uniform(random), uniform(random)};
    cloud.log_scales[i] = {-2, -3, -4};
    cloud.opacity_logits[i] = uniform(random);
    cloud.anchors[i] = static_cast<uint32_t>(i % 4);
  }
  return cloud;
}

/// Of anchors 0 to 2: none, one below what moments reach, one beyond.
std::vector<Pose> some_motions() {
  std::vector<Pose> motions(3, Pose::Identity());
  motions[1].translation() = Eigen::Vector3d(3e-4, -2e-4, 1e-4);
  motions[2] = Eigen::Translation3d(0.3, -0.9, 0.7) *
               Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, -2, 0.5).normalized());
  return motions;
}

Eigen::Matrix3d turn_of(const Eigen::Vector4f& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

/// Whether every Gaussian of `after` is where its anchor's motion takes it, in double precision.
void check_moved(const GaussianCloud& before, const GaussianCloud& after) {
  const std::vector<Pose> motions = some_motions();
  REQUIRE(after.size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Pose motion = before.anchors[i] < motions.size() ? motions[before.anchors[i]] : Pose::Identity();
    CHECK((after.means[i].cast<double>() - motion * before.means[i].cast<double>()).norm() < 1e-5);
    CHECK((turn_of(after.rotations[i]) - motion.rotation() * turn_of(before.rotations[i])).norm() < 1e-5);
    CHECK(after.rotations[i].norm() == doctest::Approx(before.rotations[i].norm()).epsilon(1e-5));
    CHECK(after.log_scales[i] == before.log_scales[i]);
    CHECK(after.opacity_logits[i] == before.opacity_logits[i]);
    CHECK(after.anchors[i] == before.anchors[i]);
  }
}

void fill_moments(GaussianMap& map) {
  map.for_each_array([&]<class T>(gpu::Array<T>& array, uint32_t words, bool state) {
    const std::vector<uint32_t> ones(map.size() * words, 1u);
    if (state) array.buffer().upload(ones.data(), 0, ones.size() * sizeof(uint32_t));
  });
}

}  // namespace

TEST_CASE("Gaussians move with their anchors; those that move far lose the moments of means and rotations") {
  for (const std::size_t count : {0u, 1u, 7u, 1000u}) {
    CAPTURE(count);
    gpu::Device& device = testing::device();
    GaussianMap map(device);
    AnchorMover mover(device);
    const GaussianCloud before = scattered(count);
    map.assign(before);
    fill_moments(map);
    mover.move(map, to_device(some_motions()));
    check_moved(before, map.download());
    const auto means = map.means.first_moment.download(count);
    const auto rotations = map.rotations.second_moment.download(count);
    const auto sizes = map.log_scales.first_moment.download(count);
    for (std::size_t i = 0; i < count; ++i) {
      const bool far = before.anchors[i] == 2;
      CHECK((means[i].y == 0) == far);
      CHECK((rotations[i].w == 0) == far);
      CHECK(sizes[i].x != 0);
    }
  }
}

TEST_CASE("without motions, and with more anchors than Gaussians, nothing moves") {
  gpu::Device& device = testing::device();
  GaussianMap map(device);
  AnchorMover mover(device);
  const GaussianCloud before = scattered(10);
  map.assign(before);
  mover.move(map, {});
  CHECK(map.download().means == before.means);
  mover.move(map, to_device(std::vector<Pose>(100, Pose::Identity())));
  CHECK(map.download().means == before.means);
}

TEST_CASE("what waits in host memory moves too, and is found where it has come to") {
  gpu::Device& device = testing::device();
  GaussianMap map(device);
  MapBlocks blocks(device);
  const GaussianCloud before = scattered(400);
  map.assign(before);
  fill_moments(map);
  blocks.focus(map, std::vector<WorldPoints>{{Eigen::Vector3f(100, 0, 0)}}, 0);
  REQUIRE(map.size() == 0);
  const auto motions = to_device(some_motions());
  blocks.move(map, motions);
  CHECK(blocks.parked() == 400);
  // Each alone is found where it is now, if what is asked for is near that.
  GaussianCloud moved;
  blocks.append_to(moved, map);
  REQUIRE(moved.size() == 400);
  const Eigen::Vector3f place = moved.means[17];
  REQUIRE(blocks.recall(map, {place}));
  const GaussianCloud near = map.download();
  CHECK(std::find(near.means.begin(), near.means.end(), place) != near.means.end());
  for (const Eigen::Vector3f& mean : near.means)
    CHECK((mean - place).cwiseAbs().maxCoeff() < 2 * MapBlocks::kEdge);
  REQUIRE(blocks.recall(map, moved.means));
  CHECK(map.size() == 400);

  // In the order of their sizes of opacity, which are all different: each as on the device.
  const auto order_of = [](const GaussianCloud& cloud) {
    std::vector<std::size_t> order(cloud.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return cloud.opacity_logits[a] < cloud.opacity_logits[b]; });
    return order;
  };
  const auto sorted = [&](const GaussianCloud& cloud) {
    GaussianCloud result;
    result.resize(cloud.size());
    const auto order = order_of(cloud);
    for (std::size_t i = 0; i < order.size(); ++i) {
      result.means[i] = cloud.means[order[i]];
      result.rotations[i] = cloud.rotations[order[i]];
      result.log_scales[i] = cloud.log_scales[order[i]];
      result.opacity_logits[i] = cloud.opacity_logits[order[i]];
      result.anchors[i] = cloud.anchors[order[i]];
    }
    return result;
  };
  check_moved(sorted(before), sorted(map.download()));
  const auto means = map.means.second_moment.download(400);
  const auto anchors = map.anchors.download(400);
  for (std::size_t i = 0; i < 400; ++i) CHECK((means[i].x == 0) == (anchors[i] == 2));
}
