#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/sources/dataset.h"

namespace surefield {

/// Which frames of a dataset to stream, and how.
struct FrameSelection {
  int start = 0;     ///< index of the first frame
  int stride = 1;    ///< every stride-th frame from there
  int frames = 0;    ///< how many frames to stream at most; 0 for all
  double scale = 1;  ///< size of the streamed images relative to the originals, in (0, 1]
  int ahead = 4;     ///< frames decoded ahead of the consumer, at most
};

/// A frame that could not be read.
struct SkippedFrame {
  int index = 0;       ///< position in the original sequence
  std::string reason;  ///< one line that names the file
};

/// Streams selected frames of a dataset in order, resized, decoded ahead on a thread of its own. One
/// consumer.
class FrameStream {
 public:
  /// Starts decoding. `dataset` must outlive the stream. Throws InputError when the selection is out of range
  /// or selects no frame.
  FrameStream(const Dataset& dataset, const FrameSelection& selection);

  /// Stops decoding, at the latest after the frame in work.
  ~FrameStream();
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  /// The next readable frame, waiting for it if need be; nullopt after the last. A frame that cannot be read
  /// is skipped and noted in skipped(). Rethrows what stops the decoder altogether, such as lack of memory.
  std::optional<Frame> next();

  /// Intrinsics of the streamed frames, Intrinsics::scaled of the dataset's.
  const Intrinsics& intrinsics() const;

  /// Number of frames selected, the unreadable ones included.
  int size() const;

  /// The frames that next() has passed over so far, in order.
  const std::vector<SkippedFrame>& skipped() const;

 private:
  struct Decoder;
  std::unique_ptr<Decoder> decoder_;
};

/// The frame resized by `scale` in (0, 1] to exactly the size and the pixel positions of Intrinsics::scaled:
/// the centre of pixel c lands at scale (c + 0.5) - 0.5. Colour is averaged over each new pixel's area; depth
/// takes the nearest original pixel, so that no depth is invented across an edge.
Frame resize_frame(const Frame& frame, double scale);

}  // namespace surefield
