#include "engine/session/kept_keyframes.h"

#include <doctest/doctest.h>

using namespace surefield;

namespace {

Frame keyframe(int index) {
  return {index, index / 30.0, cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(index % 256)), cv::Mat(1, 1, CV_32FC1)};
}

}  // namespace

TEST_CASE("as long as there are few keyframes, all are kept") {
  KeptKeyframes kept;
  CHECK(kept.frames().empty());
  CHECK(kept.find(0) == nullptr);
  for (int i = 0; i < 60; ++i) kept.add(keyframe(5 * i));
  CHECK(kept.frames().size() == 60);
  REQUIRE(kept.find(50) != nullptr);
  CHECK(kept.find(50)->colour.at<cv::Vec3b>(0, 0)[0] == 50);
  CHECK(kept.find(51) == nullptr);
}

TEST_CASE("of many, at most so many are kept, evenly spread from the first to the newest") {
  KeptKeyframes kept;
  for (int i = 0; i < 1000; ++i) {
    kept.add(keyframe(i));
    const std::vector<Frame>& frames = kept.frames();
    REQUIRE(frames.size() <= KeptKeyframes::kMost);
    CHECK(frames.front().index == 0);
    if (i < 60) continue;
    CHECK(frames.size() > KeptKeyframes::kMost / 2);
    const int step = frames[1].index;
    for (std::size_t k = 0; k < frames.size(); ++k) REQUIRE(frames[k].index == static_cast<int>(k) * step);
    CHECK(i - frames.back().index < step);
  }
}
