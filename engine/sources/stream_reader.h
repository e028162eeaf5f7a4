#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/sources/byte_source.h"
#include "engine/sources/camera_file.h"
#include "engine/sources/frame_source.h"
#include "engine/sources/undistortion.h"

namespace surefield {

/// How a frame of the framed stream (docs/live.md) stores its images; the numbers are the stream's.
enum class StreamColour : uint32_t { Rgb8 = 0, Bgr8 = 1, Jpeg = 2, Png = 3 };
enum class StreamDepth : uint32_t { Steps16 = 0, Png16 = 1, Metres32 = 2 };

/// What the first message of a stream says of all that follow.
struct StreamHeader {
  std::string name;          ///< of the camera or the sequence; printable
  RecordedCamera camera;     ///< width and height included
  bool every_frame = false;  ///< none may be dropped: the sender waits
  bool wants_poses = false;  ///< the sender reads what is sent back
  bool unix_stamps = false;  ///< stamps are seconds since 1970 by this machine's clock
};

/// A frame as it lies in the stream.
struct StreamFrame {
  int64_t message = 0;  ///< position in the stream; the header is message 1
  int index = 0;        ///< position among the frames of the stream
  double stamp = 0;     ///< seconds
  double depth_stamp = 0;
  StreamColour colour_kind = StreamColour::Rgb8;
  StreamDepth depth_kind = StreamDepth::Steps16;
  std::string colour;
  std::string depth;
  std::chrono::steady_clock::time_point arrived;  ///< when its last byte was here
};

/// Takes a framed stream apart. No length in it is trusted: each is held against what the header's sizes
/// permit before memory is taken, and memory grows with the bytes that really came. One thread.
class StreamReader {
 public:
  /// Waits for the header. `bytes` outlives this. Throws InputError where there is none, or where it says
  /// what no camera has. Of a stopped source the header is empty, and next() gives nothing.
  explicit StreamReader(ByteSource& bytes);

  const StreamHeader& header() const { return header_; }

  /// The next frame that is whole; nullopt where the stream has ended. Frames whose numbers contradict each
  /// other, or whose stamps do not grow, are passed over and added to `refused`; so is one that was cut off.
  /// Throws InputError, which names the message, where it cannot be told where the next one begins.
  std::optional<StreamFrame> next(std::vector<SkippedFrame>& refused);

  /// Whether the stream has ended without the message that says so. Any thread.
  bool ended_early() const { return ended_early_; }

 private:
  std::string read_up_to(std::size_t count);
  bool read_header();
  std::optional<uint32_t> begin_message(std::vector<SkippedFrame>& refused);
  std::optional<std::string> refuse(const StreamFrame& frame, std::size_t colour, std::size_t depth,
                                    std::size_t body) const;

  ByteSource& bytes_;
  StreamHeader header_;
  int64_t message_ = 0;
  int frames_ = 0;
  double newest_stamp_ = 0;
  bool any_accepted_ = false;
  bool ended_ = false;
  std::atomic<bool> ended_early_ = false;
};

/// Makes frames of what a stream with one header brings. May be used by any thread.
class StreamDecoder {
 public:
  explicit StreamDecoder(StreamHeader header)
      : header_(std::move(header)), undistortion_(header_.camera.intrinsics, header_.camera.distortion) {}

  /// Throws InputError, which names the message, where an image is damaged or of another size.
  Frame decode(const StreamFrame& stored) const;

 private:
  cv::Mat colour_of(const StreamFrame& stored, const std::string& name) const;
  cv::Mat depth_of(const StreamFrame& stored, const std::string& name) const;

  StreamHeader header_;
  Undistortion undistortion_;
};

}  // namespace surefield
