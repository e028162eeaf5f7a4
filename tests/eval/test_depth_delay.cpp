// The delay of depth images: on plates of which everything is known, and on a real clip.
#include "engine/eval/depth_delay.h"

#include <cmath>

#include "engine/sources/frame_stream.h"
#include "engine/sources/open_dataset.h"
#include "tests/eval/planes.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::PlanesRecording;

namespace {

/// Plates as colour images at 30 a second and depth images at 30 a second between them, each colour image
/// with the depth image that is nearest by its stamp.
class Paired : public PlanesRecording {
 public:
  static constexpr int kFrames = 60;
  static constexpr double kPhase = -0.012;  ///< stamps of depth images after those of colour images, seconds

  /// Depth images are taken `delay` seconds after what their stamps say, to which `added` seconds are added.
  Paired(double delay, double added) : PlanesRecording(kFrames), delay_(delay), added_(added) {}

  double depth_timestamp(int i) const override { return stamp_of(i) + added_; }
  LoadedFrame load(int i) const override {
    PlanesRecording planes(kFrames);
    planes.depth_delay = stamp_of(i) + delay_ - timestamp(i);
    return planes.load(i);
  }

 private:
  /// The stamp of the depth image that is nearest when the seconds are added.
  double stamp_of(int i) const {
    return timestamp(i) + kPhase - std::round((kPhase + added_) * kRate) / kRate;
  }

  double delay_, added_;
};

/// Some of a recording's frames, smaller.
class PartOf : public Recording {
 public:
  PartOf(const Recording& whole, int start, int count, double scale)
      : whole_(whole), start_(start), count_(count), scale_(scale) {}

  std::string name() const override { return whole_.name(); }
  std::string format() const override { return whole_.format(); }
  int count() const override { return count_; }
  Intrinsics intrinsics() const override { return whole_.intrinsics().scaled(scale_); }
  double depth_unit() const override { return whole_.depth_unit(); }
  double timestamp(int i) const override { return whole_.timestamp(start_ + i); }
  double depth_timestamp(int i) const override { return whole_.depth_timestamp(start_ + i); }
  LoadedFrame load(int i) const override {
    LoadedFrame loaded = whole_.load(start_ + i);
    if (loaded.frame) loaded.frame = resize_frame(*loaded.frame, scale_);
    return loaded;
  }

 private:
  const Recording& whole_;
  int start_, count_;
  double scale_;
};

DepthDelay estimated(double delay) {
  return estimate_depth_delay(Paired(delay, 0));
}

}  // namespace

TEST_CASE("depth images that are taken earlier or later than their stamps say: by how much, and how surely") {
  for (double delay : {-0.021, -0.033, 0.0, 0.01, 0.04, 0.05}) {
    CAPTURE(delay);
    const DepthDelay found = estimated(delay);
    CHECK(found.known());
    CHECK(found.error < 0.008);
    CHECK(std::abs(found.value - delay) < std::max(0.004, 3 * found.error));
    CHECK(std::abs(found.usable()) <= std::abs(found.value));
  }
}

TEST_CASE("a delay is used as far as it is certain") {
  DepthDelay delay{0.02, 0.001, 0.033};
  CHECK(delay.usable() == doctest::Approx(0.02).epsilon(0.01));
  delay.error = 0.008;
  CHECK(delay.usable() < 0.018);
  CHECK(delay.usable() > 0.012);
  delay.error = 0.011;
  CHECK(delay.usable() == 0);
  delay.value = 0.05;
  delay.error = 0.02;
  CHECK_FALSE(delay.known());
  CHECK(delay.usable() == 0);
}

TEST_CASE("nothing is known where the camera stands still, where frames are too few, or where it is ended") {
  CHECK_FALSE(estimate_depth_delay(PlanesRecording(40, false)).known());
  CHECK_FALSE(estimate_depth_delay(PlanesRecording(5)).known());
  CHECK_FALSE(estimate_depth_delay(PlanesRecording(1)).known());
  CHECK_FALSE(estimate_depth_delay(Paired(0.04, 0), [](double) { return false; }).known());
}

TEST_CASE("depth images have stamps of their own, or have not") {
  CHECK(has_depth_stamps(Paired(0, 0)));
  CHECK_FALSE(has_depth_stamps(PlanesRecording(5)));
}

TEST_CASE(
    "[slow] fr1_xyz whole, in parts and in small: depth images are 20 ms late, by edges as by the true "
    "poses") {
  const auto folder = test::real_clip("tum_fr1_xyz");
  if (folder.empty()) return;
  const Dataset dataset = open_dataset(folder);
  struct Cut {
    int start, count;
    double scale;
  };
  for (const Cut& cut : {Cut{0, 150, 1}, Cut{0, 50, 1}, Cut{50, 50, 1}, Cut{100, 50, 1}, Cut{0, 150, 0.25},
                         Cut{50, 50, 0.25}, Cut{0, 40, 0.25}, Cut{0, 50, 0.25}}) {
    CAPTURE(cut.start);
    CAPTURE(cut.count);
    CAPTURE(cut.scale);
    const DepthDelay delay =
        estimate_depth_delay(PartOf(*dataset.recording, cut.start, cut.count, cut.scale));
    // Where it is far off, the error says so.
    CHECK(std::abs(delay.value + 0.0205) < std::max(0.003, 3.5 * delay.error));
    if (cut.count < 50 || cut.scale < 1) continue;
    CHECK(std::abs(delay.value + 0.0205) < 0.0015);
    // From frame 50 on the camera moves one way for long, which a shift of the depth images explains nearly
    // as well.
    CHECK(delay.error < (cut.start == 50 ? 0.004 : 0.003));
  }
}
