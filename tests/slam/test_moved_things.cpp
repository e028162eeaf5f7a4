#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

#include "engine/slam/moved_things.h"

using namespace surefield;

namespace {

constexpr int kWidth = 160, kHeight = 120;
const Intrinsics kIntrinsics{kWidth, kHeight, 130, 130, 79.5, 59.5};
const DepthNoise kNoise = noise_of(DepthSensor::StructuredLight);

/// Something flat that faces the camera, metres in the world.
struct Board {
  double left = 0, right = 0, top = 0, bottom = 0, z = 0;
};
constexpr Board kPerson{-0.3, 0.3, -0.6, 1, 1.5};

/// A keyframe at `x` before a wall 3 m away, with boards before it.
struct View {
  ColourGrid grid;
  Camera camera{kIntrinsics, Pose::Identity()};

  explicit View(double x, const std::vector<Board>& boards = {}) {
    camera.world_to_camera.translation().x() = -x;
    Frame frame;
    frame.colour = cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar::all(90));
    frame.depth = cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(3));
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u)
        for (const Board& b : boards) {
          const double px = x + b.z * (u - kIntrinsics.cx) / kIntrinsics.fx,
                       py = b.z * (v - kIntrinsics.cy) / kIntrinsics.fy;
          auto& z = frame.depth.at<float>(v, u);
          if (px > b.left && px < b.right && py > b.top && py < b.bottom)
            z = std::min(z, static_cast<float>(b.z));
        }
    grid = make_colour_grid(frame);
  }
  DepthView depth() const { return {grid, camera}; }
};

std::vector<uint8_t> moved(const View& keyframe, const View& other) {
  const DepthView others[] = {other.depth()};
  return moved_cells(keyframe.depth(), others, kNoise);
}

}  // namespace

TEST_CASE(
    "what stands where another keyframe looked through has moved, whichever came first; what it hides has "
    "not") {
  const View before(0), after(0.25, {kPerson});
  const std::vector<uint8_t> cells = moved(after, before);
  REQUIRE(cells.size() == after.grid.depth.size());
  int person = 0, rest = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_person = after.grid.depth[i] < 2;
    person += is_person;
    if (is_person)
      CHECK(cells[i] == 1);
    else
      rest += cells[i];
  }
  CHECK(person > 100);
  CHECK(rest > 0);  // a rim of two cells
  CHECK(rest < 150);
  CHECK(moved(before, after).empty());
}

TEST_CASE(
    "nothing has moved in a scene at rest, seen from two places, nor where the other is blind or did not "
    "look") {
  const std::vector<Board> still{kPerson, {0.5, 1, -0.5, 1, 2}, {-1.4, -1.36, -1, 1, 1.2}};
  CHECK(moved(View(0, still), View(0.4, still)).empty());
  CHECK(moved(View(0.4, still), View(0, still)).empty());
  View blind(0.1);
  std::fill(blind.grid.depth.begin(), blind.grid.depth.end(), 0.0f);
  CHECK(moved(View(0, {kPerson}), blind).empty());
  CHECK(moved(View(0, {kPerson}), View(30)).empty());
  CHECK(moved_cells(View(0, {kPerson}).depth(), {}, kNoise).empty());
}

TEST_CASE("what is thin, small, or as near to what is behind as the sensor can tell, does not count") {
  CHECK(moved(View(0, {{-0.02, 0.02, -1, 1, 1.5}}), View(0.2)).empty());
  CHECK(moved(View(0, {{-0.05, 0.05, -0.05, 0.05, 1.5}}), View(0.2)).empty());
  CHECK(moved(View(0, {{-0.6, 0.6, -0.6, 0.6, 2.95}}), View(0.2)).empty());
  CHECK_FALSE(moved(View(0, {{-0.6, 0.6, -0.6, 0.6, 2.7}}), View(0.2)).empty());
}

TEST_CASE("cells are laid on all pixels, those beyond the last whole cell included") {
  ColourGrid grid;
  grid.width = 3, grid.height = 2, grid.cell = 4;
  const std::vector<uint8_t> pixels = pixels_of_cells({1, 0, 0, 0, 0, 1}, grid, {14, 9});
  REQUIRE(pixels.size() == 14 * 9);
  const auto at = [&](int u, int v) { return pixels[static_cast<std::size_t>(v) * 14 + u]; };
  CHECK(at(0, 0) == 1);
  CHECK(at(3, 3) == 1);
  CHECK(at(4, 3) == 0);
  CHECK(at(3, 4) == 0);
  CHECK(at(8, 4) == 1);
  CHECK(at(13, 8) == 1);
  CHECK(at(7, 8) == 0);
}
