#include <doctest/doctest.h>

#include "engine/gpu/recorder.h"
#include "engine/splat/mapper.h"
#include "engine/splat/tracking_loss.h"
#include "tests/reference/losses.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"
#include "tests/splat/compare.h"
#include "tests/splat/upstream.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::largest_difference;
using testing::magnitude;

namespace {

/// A scene, what a camera saw of it in the 8 bits that frames have, and what the device renders of it.
struct Observed {
  reference::Scene scene;
  std::vector<uint8_t> colour_bytes;
  std::vector<float> colour;  ///< the same in [0, 1]
  RenderImages rendered;
};

Observed observe(const reference::Scene& scene, Rasteriser& rasteriser, const GaussianMap& map) {
  Observed o{scene, {}, {}, rasteriser.render(map, scene.camera, scene.depth)};
  for (float c : scene.colour) {
    o.colour_bytes.push_back(static_cast<uint8_t>(std::lround(c * 255)));
    o.colour.push_back(static_cast<float>(o.colour_bytes.back()) / 255);
  }
  return o;
}

FrameView view_of(const Observed& o) {
  return {o.rendered.width, o.rendered.height, o.colour_bytes.data(), o.scene.depth.data()};
}

/// What the device left for the backward passes, field by field, and as the oracle's dL/d(images) has it.
void compare_upstream(const std::vector<glsl::PixelUpstream>& got, const reference::ImageGradients& gradients,
                      const RenderImages& images, const std::vector<uint8_t>& skip) {
  std::vector<glsl::PixelUpstream> want;
  for (std::size_t i = 0; i < got.size(); ++i) want.push_back(testing::upstream_at(gradients, images, i));
  const auto check = [&](const std::string& name, auto field) {
    CAPTURE(name);
    std::vector<double> device, oracle;
    for (std::size_t i = 0; i < got.size(); ++i) {
      if (skip[i]) continue;
      device.push_back(field(got[i]));
      oracle.push_back(field(want[i]));
    }
    CHECK(largest_difference(device, oracle, magnitude(oracle)) < 1e-3);
  };
  using Pixel = glsl::PixelUpstream;
  check("red", [](const Pixel& p) { return p.colour.x; });
  check("green", [](const Pixel& p) { return p.colour.y; });
  check("blue", [](const Pixel& p) { return p.colour.z; });
  check("depth", [](const Pixel& p) { return p.depth; });
  check("constant", [](const Pixel& p) { return p.constant; });
  check("total", [](const Pixel& p) { return p.total; });
  check("median", [](const Pixel& p) { return p.median; });
  check("uncertainty", [](const Pixel& p) { return p.uncertainty; });
}

}  // namespace

TEST_CASE("the mapping loss and its gradient agree with the oracle") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  Mapper mapper(device);
  GaussianMap map(device);
  for (DepthKind kind : {DepthKind::Alpha, DepthKind::Normalised})
    for (const auto& size : {std::pair{1, 1}, {9, 5}, {48, 36}, {83, 61}}) {
      const int width = size.first, height = size.second;
      CAPTURE(width);
      const auto scene = reference::random_scene(7, 200, {.width = width, .height = height});
      map.assign(scene.cloud);
      const Observed o = observe(scene, rasteriser, map);
      const SensorFrame frame(device, view_of(o));
      const Eigen::Vector3f gains(1.25f, 0.75f, 1.5f);
      CameraVariable camera(device, scene.camera, gains);
      std::vector<float> target = o.colour;
      for (std::size_t i = 0; i < target.size(); ++i) target[i] *= gains[i % 3];
      MappingSettings settings;
      settings.depth = kind;
      gpu::Recorder recorder(device);
      mapper.record_loss(recorder, rasteriser, map, frame, camera, settings);
      recorder.submit();

      // The oracle's loss of the device's own images: what is compared is the loss alone.
      const reference::Images images(o.rendered);
      const auto want = reference::mapping_loss(
          images, {target, o.scene.depth}, reference::Gaussians(scene.cloud),
          std::vector<uint8_t>(scene.cloud.size(), 0),
          {.colour = settings.weight_colour,
           .ssim = settings.weight_ssim,
           .depth = settings.weight_depth,
           .align = settings.weight_align,
           .isotropy = 0,
           .variance = settings.weight_variance,
           .depth_kind =
               kind == DepthKind::Alpha ? reference::DepthKind::alpha : reference::DepthKind::normalised});
      CHECK(mapper.read_loss(frame, settings) == doctest::Approx(want.total).epsilon(1e-4));
      // Where depth and median agree to the last bits, the sign of their difference is a matter of rounding.
      std::vector<uint8_t> skip(images.opacity.size(), 0);
      for (std::size_t i = 0; i < skip.size(); ++i) {
        const double depth = kind == DepthKind::Alpha ? images.depth[i] : images.depth_normalised[i];
        skip[i] = images.depth_median[i] > 0 && std::abs(depth - images.depth_median[i]) < 1e-5;
      }
      compare_upstream(rasteriser.pixel_upstream.download(frame.size.pixels()), want.images, o.rendered,
                       skip);
    }
}

TEST_CASE("hidden pixels have no part in the mapping loss") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  Mapper mapper(device);
  GaussianMap map(device);
  const auto scene = reference::random_scene(7, 200, {.width = 48, .height = 36});
  map.assign(scene.cloud);
  const Observed o = observe(scene, rasteriser, map);
  SensorFrame frame(device, view_of(o));
  frame.depth.upload(std::vector<float>(frame.size.pixels(), -1.0f));
  CameraVariable camera(device, scene.camera);
  gpu::Recorder recorder(device);
  mapper.record_loss(recorder, rasteriser, map, frame, camera, {.weight_align = 0});
  recorder.submit();
  for (const glsl::PixelUpstream& p : rasteriser.pixel_upstream.download(frame.size.pixels())) {
    CHECK(p.constant == 0);
    CHECK(p.total == 0);
    CHECK(p.colour.x == 0);
    CHECK(p.uncertainty == 0);
  }
}

TEST_CASE("the tracking loss, its masks and its gradient agree with the oracle") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  TrackingLoss loss(device);
  gpu::Array<glsl::CameraState> camera(device, "camera");
  GaussianMap map(device);
  for (DepthKind kind : {DepthKind::Alpha, DepthKind::Normalised})
    for (double minimum_opacity : {0.3, 0.9}) {
      auto scene =
          reference::random_scene(9, 400, {.kind = reference::SceneKind::mixed, .width = 61, .height = 47});
      map.assign(scene.cloud);
      // A few gross outliers, so that the masks have something to do.
      for (std::size_t i = 0; i < scene.depth.size(); i += 29) scene.depth[i] *= 40;
      const Observed o = observe(scene, rasteriser, map);
      const SensorFrame frame(device, view_of(o));
      TrackingSettings settings;
      settings.depth = kind;
      settings.minimum_opacity = minimum_opacity;
      const glsl::CameraState state = to_device(scene.camera);
      camera.upload(std::span(&state, 1));
      gpu::Recorder recorder(device);
      const View view = tracking_view(frame, camera, settings);
      loss.record(recorder, rasteriser, map, view, frame, settings);
      loss.record_gradient(recorder, rasteriser, view, frame, settings);
      recorder.submit();

      const auto want = reference::tracking_loss(
          reference::Images(o.rendered), {o.colour, o.scene.depth},
          {.colour = settings.weight_colour,
           .depth = settings.weight_depth,
           .minimum_opacity = minimum_opacity,
           .outlier_factor = settings.outlier_factor,
           .depth_kind =
               kind == DepthKind::Alpha ? reference::DepthKind::alpha : reference::DepthKind::normalised});
      const glsl::TrackSums sums = loss.sums.download(1)[0];
      double colour_pixels = 0, depth_pixels = 0;
      for (auto m : want.colour_mask) colour_pixels += m;
      for (auto m : want.depth_mask) depth_pixels += m;
      REQUIRE(depth_pixels > 50);
      // The device's median is interpolated in a bin of 1/64 octave; no residual may lie between the two
      // limits.
      CHECK(sums.colour_pixels == colour_pixels);
      CHECK(sums.depth_pixels == depth_pixels);
      CHECK(sums.colour / sums.colour_pixels == doctest::Approx(want.colour).epsilon(1e-4));
      CHECK(sums.depth / sums.depth_pixels == doctest::Approx(want.depth).epsilon(1e-4));
      compare_upstream(rasteriser.pixel_upstream.download(frame.size.pixels()), want.images, o.rendered,
                       std::vector<uint8_t>(frame.size.pixels(), 0));
    }
}
