#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/sources/arrival_count.h"
#include "engine/sources/byte_source.h"
#include "engine/sources/newest_slot.h"
#include "engine/sources/stream_reader.h"

namespace surefield {

/// The frames of a framed stream (docs/live.md). Where the sender says that every frame counts, they are read
/// as they are asked for, and it waits; else a thread reads them as they come and keeps the newest, which is
/// decoded when it is asked for. A sender that goes away ends the source as one that says goodbye does.
class StreamSource : public FrameSource {
 public:
  /// Waits for the header. Throws InputError where that is wrong or none comes. A source that was stopped
  /// meanwhile has no frames, and intrinsics of size 0.
  explicit StreamSource(std::unique_ptr<ByteSource> bytes);
  ~StreamSource() override;
  StreamSource(const StreamSource&) = delete;
  StreamSource& operator=(const StreamSource&) = delete;

  const StreamHeader& header() const { return reader_.header(); }

  std::string name() const override { return header().name; }
  /// "live"
  std::string format() const override { return "live"; }
  Intrinsics intrinsics() const override { return header().camera.intrinsics; }
  std::optional<int> size() const override { return std::nullopt; }
  std::optional<Frame> next() override;
  void stop() override;
  const std::vector<SkippedFrame>& problems() const override { return problems_; }
  std::optional<LiveCounts> live() const override;
  /// Sends a line back to a sender that reads poses, as ByteSource::send(). Any thread.
  bool answer(std::string_view line) { return bytes_->send(line); }
  /// Whether the sender has gone, or the stream was cut off, without the message that ends it; to be asked
  /// when next() has given the last frame.
  bool ended_early() const { return reader_.ended_early(); }

 private:
  void receive() noexcept;
  std::optional<StreamFrame> next_stored();
  void take_refused();

  std::unique_ptr<ByteSource> bytes_;
  StreamReader reader_;
  StreamDecoder decoder_;
  std::vector<SkippedFrame> problems_;

  NewestSlot<StreamFrame> newest_;
  ArrivalCount arrivals_;
  std::mutex mutex_;  ///< guards what follows
  std::vector<SkippedFrame> refused_;
  std::thread receiver_;  ///< last; runs where the newest frame wins
};

}  // namespace surefield
