#pragma once

#include <cstddef>
#include <string_view>

namespace surefield {

/// Bytes that come one after the other: from a pipe, a socket, a test. read() is for one thread at a time,
/// stop() and stopped() for any.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Waits for bytes and puts up to `most` (at least 1) of them at `to`; returns how many. 0: there will be
  /// no more, as whoever wrote them is gone, or stop() was called.
  virtual std::size_t read(char* to, std::size_t most) = 0;

  /// Sends text back, whole or not at all, without ever waiting. False where there is no way back, or whoever
  /// is there does not read. Any thread.
  virtual bool send(std::string_view) { return false; }

  /// Has read() return 0 from now on, also where it waits.
  virtual void stop() = 0;
  virtual bool stopped() const = 0;
};

}  // namespace surefield
