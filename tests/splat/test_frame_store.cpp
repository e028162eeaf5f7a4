#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "engine/splat/frame_store.h"
#include "engine/types/error.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

constexpr int kWidth = 7, kHeight = 5;

/// Images of their own for every `seed`, with invalid depth in them.
struct Images {
  std::vector<uint8_t> colour;
  std::vector<float> depth;

  explicit Images(int seed) {
    for (int i = 0; i < 3 * kWidth * kHeight; ++i) colour.push_back(static_cast<uint8_t>(31 * seed + 7 * i));
    for (int i = 0; i < kWidth * kHeight; ++i) depth.push_back(static_cast<float>(seed + i % 11) / 5000);
    depth[3] = NAN;
    depth[4] = -1;
    depth[5] = 100;
  }
  FrameView view() const { return {kWidth, kHeight, colour.data(), depth.data()}; }
};

void check_holds(FrameStore& store, FrameHandle frame, int seed) {
  const SensorFrame want(testing::device(), Images(seed).view());
  const SensorFrame& got = store.on_device(frame);
  CAPTURE(seed);
  CHECK(got.size.width == want.size.width);
  CHECK(got.size.height == want.size.height);
  CHECK(got.valid_pixels == want.valid_pixels);
  CHECK(got.colour.download(kWidth * kHeight) == want.colour.download(kWidth * kHeight));
  CHECK(got.depth.download(kWidth * kHeight) == want.depth.download(kWidth * kHeight));
}

}  // namespace

TEST_CASE(
    "packed images come back bit by bit, whether depth has few values or more than two bytes tell apart") {
  for (const std::size_t pixels : {std::size_t{1000}, std::size_t{65536}, std::size_t{65537}}) {
    std::vector<uint32_t> colour;
    std::vector<float> depth;
    for (uint32_t i = 0; i < pixels; ++i) {
      colour.push_back((i * 2654435761u) | 0xFF000000u);
      depth.push_back(std::bit_cast<float>(0x40000000u + 3 * i));
    }
    const PackedImages packed(colour, depth);
    CHECK(packed.colour() == colour);
    CHECK(packed.depth() == depth);
  }
  const std::vector<uint32_t> colour(50000, 0xFF112233u);
  std::vector<float> millimetres;
  for (int i = 0; i < 50000; ++i) millimetres.push_back(static_cast<float>(i % 4000) / 1000);
  const PackedImages packed(colour, millimetres);
  CHECK(packed.depth() == millimetres);
  CHECK(packed.bytes() == 50000 * 5 + 4000 * 4);
}

TEST_CASE(
    "frames that had to leave the device come back as they were, and device memory stays that of a few") {
  gpu::Device& device = testing::device();
  FrameStore store(device);
  std::vector<FrameHandle> frames;
  uint64_t full = 0;
  for (int seed = 0; seed < 30; ++seed) {
    frames.push_back(store.load(Images(seed).view()));
    if (seed + 1 == static_cast<int>(FrameStore::kPlaces)) full = device.memory_in_use();
  }
  CHECK(device.memory_in_use() == full);
  for (int seed : {29, 0, 17, 1, 2, 3, 4, 5, 6, 7, 8, 0, 29}) check_holds(store, frames[seed], seed);
  CHECK(device.memory_in_use() == full);
}

TEST_CASE("the frames asked for last stay on the device, and the place of a released frame is used again") {
  FrameStore store(testing::device());
  std::vector<FrameHandle> frames;
  for (int seed = 0; seed < 12; ++seed) frames.push_back(store.load(Images(seed).view()));
  const SensorFrame& held = store.on_device(frames[0]);
  for (std::size_t i = 1; i < FrameStore::kPlaces; ++i) store.on_device(frames[i]);
  CHECK(&store.on_device(frames[0]) == &held);
  store.release(frames[0]);
  CHECK_THROWS_AS(store.on_device(frames[0]), UsageError);
  const FrameHandle successor = store.load(Images(20).view());
  CHECK(&store.on_device(successor) == &held);
  check_holds(store, successor, 20);
  check_holds(store, frames[11], 11);
}

TEST_CASE(
    "hidden pixels show nothing, on the device and after they had to leave it; others are as they were") {
  FrameStore store(testing::device());
  const FrameHandle frame = store.load(Images(3).view());
  std::vector<float> want = store.on_device(frame).depth.download(kWidth * kHeight);
  const uint32_t valid = store.on_device(frame).valid_pixels;
  std::vector<uint8_t> flags(kWidth * kHeight);
  for (int i : {0, 3, 17}) flags[i] = 1, want[i] = -1;  // 3 had no depth
  store.hide(frame, flags);
  store.hide(frame, flags);
  const auto check = [&] {
    CHECK(store.on_device(frame).depth.download(kWidth * kHeight) == want);
    CHECK(store.on_device(frame).valid_pixels == valid - 2);
  };
  check();
  for (int seed = 4; seed < 20; ++seed) store.load(Images(seed).view());
  check();
  flags[1] = 1, want[1] = -1;
  store.hide(frame, flags);
  CHECK(store.on_device(frame).valid_pixels == valid - 3);
  CHECK_THROWS_AS(store.hide(frame, std::vector<uint8_t>(4)), UsageError);
  CHECK_THROWS_AS(store.hide(999, flags), UsageError);
}
