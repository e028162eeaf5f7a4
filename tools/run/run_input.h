#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "engine/sources/frame_stream.h"
#include "engine/sources/open_dataset.h"
#include "engine/sources/open_live.h"
#include "engine/sources/prompt_stream.h"
#include "engine/sources/timed_replay.h"
#include "tools/results/run_configuration.h"

namespace surefield {

/// Where the frames of a run come from: a recording, one that is replayed at its own speed, or a live source.
class RunInput {
 public:
  /// Opens what the options name; of a live source, waits for it. Throws InputError.
  explicit RunInput(const RunOptions& options);

  /// Whether the user has ended the wait for a live source: there are no frames then.
  bool given_up() const { return !dataset_.recording && !live_.source; }

  /// Begins to stream the selected frames. Throws InputError where the selection makes no sense.
  void stream(const FrameSelection& selection);
  /// The frames that are fed, after stream().
  FrameSource& frames() { return prompt_ ? static_cast<FrameSource&>(*prompt_) : *ahead_; }
  /// The whole of what they are selected from.
  const FrameSource& source() const;

  const Recording* recording() const { return dataset_.recording.get(); }
  const Trajectory* truth() const { return dataset_.truth(); }
  /// Null where the frames come from anywhere else.
  StreamSource* framed_stream() const { return live_.stream; }

  /// As FrameStream::idle_within().
  bool idle_within(std::chrono::milliseconds patience) const {
    return !ahead_ || ahead_->idle_within(patience);
  }

 private:
  Dataset dataset_;
  LiveSource live_;
  std::unique_ptr<TimedReplay> replay_;
  std::unique_ptr<FrameStream> ahead_;    ///< where frames wait until they are asked for
  std::unique_ptr<PromptStream> prompt_;  ///< where the newest wins
};

}  // namespace surefield
