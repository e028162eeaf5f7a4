#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/sources/frame_source.h"

namespace surefield {

/// What loading one frame gave: the frame, or the reason why there is none.
struct LoadedFrame {
  std::optional<Frame> frame;
  std::string
      problem;  ///< empty where there is a frame; else one line that names the file and what is wrong with it
};

/// Seconds from the stamp of a colour image to that of its depth image; 0 where they are so far apart (0.1 s)
/// that they are of two clocks.
double depth_after(double colour_stamp, double depth_stamp);

/// A source whose frames can be read again, in any order: a recorded or a synthetic RGB-D sequence. But for
/// the place that next() has reached it never changes: load() may be called from any thread.
class Recording : public FrameSource {
 public:
  /// Number of frames, the unreadable ones included.
  virtual int count() const = 0;

  /// Colour images of the sequence that became no frame, because no depth image belongs to them.
  virtual int left_out() const { return 0; }

  /// Metres for one step of the stored depth images.
  virtual double depth_unit() const = 0;

  /// Seconds; the original frame index where the sequence has no stamps. 0 <= i < count().
  virtual double timestamp(int i) const = 0;

  /// Seconds; when the depth image of frame `i` was taken, where the sequence says so, else timestamp(i).
  virtual double depth_timestamp(int i) const { return timestamp(i); }

  /// Frame::depth_after of frame `i`, by its stamps.
  double depth_after(int i) const { return surefield::depth_after(timestamp(i), depth_timestamp(i)); }

  /// Reads and undistorts frame `i` at the original size, 0 <= i < count(). A missing or corrupt image is no
  /// exception: the caller skips the frame, counts it and reports the problem. Depth is not cut at any
  /// maximum.
  virtual LoadedFrame load(int i) const = 0;

  /// count()
  std::optional<int> size() const final { return count(); }
  /// Loads one frame after the other, from the first.
  std::optional<Frame> next() final;
  const std::vector<SkippedFrame>& problems() const final { return problems_; }
  const Recording* recording() const final { return this; }

 private:
  int next_ = 0;
  std::vector<SkippedFrame> problems_;
};

}  // namespace surefield
