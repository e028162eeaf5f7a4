#pragma once

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>
#include <utility>

#include "engine/sources/byte_source.h"

namespace surefield::test {

/// Bytes of numbers in the order of the machine, which is that of the stream.
template <typename T>
std::string bytes_of(const T& value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
}

inline std::string pixels_of(const cv::Mat& image) {
  return std::string(reinterpret_cast<const char*>(image.data), image.total() * image.elemSize());
}

inline std::string stream_message(const std::string& tag, const std::string& body) {
  return tag + bytes_of(static_cast<uint32_t>(body.size())) + body;
}

/// A header of the framed stream, written by docs/live.md and not by the code that reads it.
struct HeaderToSend {
  uint32_t version = 1;
  uint32_t flags = 0;
  uint32_t width = 8, height = 6;
  std::array<double, 4> camera = {10, 10, 3.5, 2.5};
  double depth_unit = 0.001;
  uint32_t model = 0, coefficients = 0;
  std::array<double, 14> distortion{};
  std::string name = "bench camera";

  std::string message() const {
    std::string padded = name;
    padded.resize(64);
    return stream_message("SFLH", bytes_of(version) + bytes_of(flags) + bytes_of(width) + bytes_of(height) +
                                      bytes_of(camera) + bytes_of(depth_unit) + bytes_of(model) +
                                      bytes_of(coefficients) + bytes_of(distortion) + padded);
  }
};

/// A frame of it.
struct FrameToSend {
  double stamp = 0;
  uint32_t colour_kind = 0, depth_kind = 0;
  std::string colour = std::string(8 * 6 * 3, '\x40');
  std::string depth = std::string(8 * 6 * 2, '\x04');
  double depth_after = 0;

  std::string message() const {
    return stream_message("SFLF", bytes_of(colour_kind) + bytes_of(depth_kind) + bytes_of(stamp) +
                                      bytes_of(stamp + depth_after) +
                                      bytes_of(static_cast<uint32_t>(colour.size())) +
                                      bytes_of(static_cast<uint32_t>(depth.size())) + colour + depth);
  }
};

inline std::string end_message() {
  return stream_message("SFLE", "");
}

/// Bytes in memory, a few at a time. Where `waits`, the end of them is no end: whoever reads waits for more,
/// or for stop().
class MemoryBytes : public ByteSource {
 public:
  explicit MemoryBytes(std::string bytes, std::size_t most = 7, bool waits = false)
      : bytes_(std::move(bytes)), most_(most), waits_(waits) {}

  std::size_t read(char* to, std::size_t most) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || at_ < bytes_.size() || !waits_; });
    if (stopped_) return 0;
    const std::size_t count = std::min({most, most_, bytes_.size() - at_});
    std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
    return count;
  }
  void stop() override {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
  }
  bool stopped() const override {
    const std::lock_guard lock(mutex_);
    return stopped_;
  }

  void add(const std::string& bytes) {
    {
      const std::lock_guard lock(mutex_);
      bytes_ += bytes;
    }
    changed_.notify_all();
  }
  /// No more bytes will be added.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      waits_ = false;
    }
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string bytes_;
  std::size_t at_ = 0;
  const std::size_t most_;
  bool waits_;
  bool stopped_ = false;
};

}  // namespace surefield::test
