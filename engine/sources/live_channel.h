#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "engine/sources/byte_source.h"

namespace surefield {

/// A file descriptor that is closed with the object.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  int get() const { return number_; }
  bool is_open() const { return number_ >= 0; }

 private:
  int release() noexcept { return std::exchange(number_, -1); }
  int number_ = -1;
};

/// Where a sender's bytes come in: standard input, or a socket on which this program listens for one sender,
/// to whom it may answer. stop() and send() may be called by any thread.
class LiveChannel : public ByteSource {
 public:
  /// "-", "unix:PATH" or "tcp:ADDRESS:PORT" with a numeric IPv4 address of this machine; port 0 takes one
  /// that is free. Listens from here on. Throws InputError where that is no such address, or cannot be
  /// listened at.
  explicit LiveChannel(const std::string& address);
  /// Removes the socket's file where no sender has come.
  ~LiveChannel() override;

  /// Where senders are expected, with the port that was taken; empty for standard input.
  const std::string& listening() const { return listening_; }

  /// Waits for the sender; no other one is taken afterwards. False where stop() was called.
  bool wait_for_sender();

  std::size_t read(char* to, std::size_t most) override;
  void stop() override;
  bool stopped() const override { return stopped_; }

  /// Sends text back, without ever waiting: what the sender does not read is kept up to a megabyte. False
  /// where there is no way back (standard input, a sender that is gone), or no more is kept.
  bool send(std::string_view text) override;

 private:
  void listen_unix(const std::string& path);
  void listen_tcp(const std::string& address, const std::string& place);
  bool wait_readable(int descriptor) const;
  void remove_file();

  std::string listening_;
  std::filesystem::path file_;  ///< of the socket that listens; empty: none
  Descriptor listener_;
  Descriptor input_;
  Descriptor wake_;  ///< readable once stop() was called
  std::atomic<bool> stopped_{false};

  std::mutex sending_;  ///< guards what follows
  std::string unsent_;
  bool way_back_ = false;
};

}  // namespace surefield
