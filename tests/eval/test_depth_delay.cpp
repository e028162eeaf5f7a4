// The delay of depth images: on plates of which everything is known, and on a real clip.
#include "engine/eval/depth_delay.h"

#include <cmath>

#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
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

double estimated(double delay) {
  return estimate_depth_delay(Paired(delay, 0),
                              [&](double added) { return std::make_unique<Paired>(delay, added); });
}

}  // namespace

TEST_CASE("depth images that are taken earlier or later than their stamps say: by how much is found") {
  for (double delay : {-0.021, -0.033, 0.04, 0.05}) {
    CAPTURE(delay);
    CHECK(std::abs(estimated(delay) - delay) < 0.006);
  }
}

TEST_CASE(
    "depth images whose nearest partner is the right one, and sequences without such stamps: no delay") {
  CHECK(estimated(0) == 0);
  CHECK(estimated(0.01) == 0);
  const auto open = [](double) -> std::unique_ptr<Recording> {
    FAIL("opened, though depth images have no stamps of their own");
    return nullptr;
  };
  CHECK(estimate_depth_delay(PlanesRecording(30), open) == 0);
}

TEST_CASE("nothing fits together one image earlier or later: no delay") {
  const auto open = [](double) -> std::unique_ptr<Recording> { throw InputError("no pairs"); };
  CHECK(estimate_depth_delay(Paired(0.04, 0), open) == 0);
}

TEST_CASE("too few frames: no delay") {
  const auto open = [](double added) { return std::make_unique<Paired>(0.03, added); };
  class Short : public Paired {
   public:
    using Paired::Paired;
    int count() const override { return 5; }
  };
  CHECK(estimate_depth_delay(Short(0.03, 0), open) == 0);
}

TEST_CASE(
    "[slow] fr1_xyz: depth images are about two thirds of a frame late, by edges as by the true poses") {
  const auto folder = test::real_clip("tum_fr1_xyz");
  if (folder.empty()) return;
  const auto open = [&](double added) { return open_dataset(folder, "tum", added).recording; };
  const double delay = estimate_depth_delay(*open(0), open);
  CHECK(delay < -0.015);
  CHECK(delay > -0.03);
  // Taken at its word, the estimate leaves nothing to be found.
  const auto again = [&](double added) { return open(delay + added); };
  CHECK(estimate_depth_delay(*open(delay), again) == 0);
}
