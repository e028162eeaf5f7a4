#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/sources/frame_stream.h"

namespace surefield {

/// Selected frames of a source whose frames come in their own time, resized: as FrameStream, but nothing is
/// decoded ahead, so that what next() gives is the newest there is. One consumer.
class PromptStream : public FrameSource {
 public:
  /// `source` outlives this, and nobody else asks it for frames. Positions count the frames that it gives and
  /// those that it passes over, but not those that it drops. Throws InputError where `selection` makes no
  /// sense.
  PromptStream(FrameSource& source, const FrameSelection& selection);

  std::string name() const override { return source_.name(); }
  std::string format() const override { return source_.format(); }
  Intrinsics intrinsics() const override { return intrinsics_; }
  std::optional<int> size() const override { return std::nullopt; }
  /// Throws InputError where the selection gives up.
  std::optional<Frame> next() override;
  void stop() override { source_.stop(); }
  const std::vector<SkippedFrame>& problems() const override { return source_.problems(); }
  std::vector<std::string> assumptions() const override { return source_.assumptions(); }
  std::vector<std::string> warnings() const override { return source_.warnings(); }
  Pose tracked_to_reference() const override { return source_.tracked_to_reference(); }
  std::optional<LiveCounts> live() const override { return source_.live(); }
  const Recording* recording() const override { return source_.recording(); }

 private:
  void give_up_if_hopeless() const;

  FrameSource& source_;
  const FrameSelection selection_;
  const Intrinsics intrinsics_;
  int position_ = 0;
  int given_ = 0;
};

}  // namespace surefield
