#pragma once

#include <cstdint>

#include "engine/io/dataset.h"
#include "engine/synth/room.h"

namespace surefield {

/// Which synthetic sequence to make. The default is the embedded sequence of the demo.
struct SynthSettings {
  int width = 320;   ///< pixels
  int height = 240;  ///< pixels
  int frames = 60;   ///< number of frames, at 30 a second
  uint32_t seed = 1;
};

/// A walk through SyntheticRoom as a sequence with exact ground truth: needs no files, renders each frame
/// when it is loaded. The same settings give the same bits on every run.
class SyntheticDataset : public Dataset {
 public:
  /// Throws InputError where a size or the number of frames is not positive.
  explicit SyntheticDataset(const SynthSettings& settings = {});

  std::string name() const override { return "synthetic"; }
  std::string format() const override { return "synthetic"; }
  int size() const override { return settings_.frames; }
  /// Square pixels, centred, a horizontal field of view of about 61 degrees.
  Intrinsics intrinsics() const override;
  /// 1: depth is made in metres and never rounded to steps.
  double depth_unit() const override { return 1.0; }
  /// i / 30 seconds.
  double timestamp(int i) const override { return i / 30.0; }
  LoadedFrame load(int i) const override;
  const Trajectory* ground_truth() const override { return &ground_truth_; }

 private:
  SynthSettings settings_;
  SyntheticRoom room_;
  Trajectory ground_truth_;
};

}  // namespace surefield
