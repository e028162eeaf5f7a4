#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/sources/recording.h"

namespace surefield {

/// Which frames of a source to stream, and how. Positions count the frames that the source gives and those
/// that it passes over.
struct FrameSelection {
  int start = 0;     ///< position of the first frame
  int stride = 1;    ///< every stride-th frame from there
  int frames = 0;    ///< how many frames to stream at most; 0 for all
  double scale = 1;  ///< size of the streamed images relative to the originals, in (0, 1]
  int ahead = 4;     ///< frames decoded ahead of the consumer, at most
  int hopeless =
      0;  ///< gives up after so many frames that cannot be read before the first that can; 0: never
};

/// The intrinsics of selected frames: those of the source, scaled. Throws InputError where the selection
/// makes no sense by itself or leaves no pixel.
Intrinsics selected_intrinsics(const FrameSource& source, const FrameSelection& selection);

/// Streams selected frames of a source in order, resized, decoded ahead on a thread of its own. One consumer.
class FrameStream : public FrameSource {
 public:
  /// Starts decoding; only the selected frames are loaded. `recording` must outlive the stream, and may be
  /// streamed and loaded from by others at the same time. Throws InputError when the selection is out of
  /// range or selects no frame.
  FrameStream(const Recording& recording, const FrameSelection& selection);

  /// The same for any source: reads it front to back, those that are not selected too, and nobody else may
  /// call its next() or problems() meanwhile. Where nobody knows the source's size, start may lie beyond its
  /// end.
  FrameStream(FrameSource& source, const FrameSelection& selection);

  /// Stops decoding, at the latest after the frame in work, or that the source waits for.
  ~FrameStream() override;
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  std::string name() const override;
  std::string format() const override;
  /// Intrinsics::scaled of the source's.
  Intrinsics intrinsics() const override;
  /// Number of frames selected, the unreadable ones included; nullopt where the source's is not known.
  std::optional<int> size() const override;
  void stop() override;
  /// Waits until no frame is being read; false where that takes longer, as from a disk that does not answer.
  bool idle_within(std::chrono::milliseconds patience) const;
  /// Throws InputError where it gives up. Rethrows what stops the decoder altogether, such as lack of memory,
  /// after the frames before it.
  std::optional<Frame> next() override;
  /// Of the selected frames.
  const std::vector<SkippedFrame>& problems() const override;
  std::vector<std::string> assumptions() const override;
  std::vector<std::string> warnings() const override;
  Pose tracked_to_reference() const override;
  std::optional<LiveCounts> live() const override;
  /// The source's: all of its frames, at their original size.
  const Recording* recording() const override;

 private:
  struct Decoder;
  std::unique_ptr<Decoder> decoder_;
};

/// The frame resized by `scale` in (0, 1] to exactly the size and the pixel positions of Intrinsics::scaled:
/// the centre of pixel c lands at scale (c + 0.5) - 0.5. Colour is averaged over each new pixel's area; depth
/// takes the nearest original pixel, so that no depth is invented across an edge.
Frame resize_frame(const Frame& frame, double scale);

}  // namespace surefield
