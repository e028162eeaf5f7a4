#pragma once

#include <cstddef>
#include <vector>

#include "engine/session/run_observer.h"

namespace surefield {

/// Watches a run whose source cannot be read again and keeps images of its keyframes for what is done
/// afterwards: never more than so many, evenly spread over the keyframes so far. Keeps none of a source that
/// can be read again.
class KeptKeyframes : public RunObserver {
 public:
  static constexpr std::size_t kMost = 60;

  void begin(const RunStart& start) override { wanted_ = start.source.recording() == nullptr; }
  void fed(const Frame& frame, const Slam&, const FrameReport& report) override {
    if (wanted_ && report.keyframe) add(frame);
  }

  /// Keyframes come in order. The images are shared, not copied.
  void add(const Frame& keyframe);

  /// In order; the first keyframe is always among them.
  const std::vector<Frame>& frames() const { return frames_; }

  /// The kept keyframe of a Frame::index, as long as none is added; null where it is not kept.
  const Frame* find(int index) const;

 private:
  bool wanted_ = false;
  std::vector<Frame> frames_;
  std::size_t every_ = 1;  ///< one in so many keyframes is kept
  std::size_t added_ = 0;
};

}  // namespace surefield
