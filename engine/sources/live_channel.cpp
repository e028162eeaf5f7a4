#include "engine/sources/live_channel.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kMostUnsent = std::size_t{1} << 20;
constexpr const char* kAddresses =
    "; give - (standard input), unix:PATH, tcp:127.0.0.1:PORT or openni2[:URI] (docs/live.md)";

[[noreturn]] void fail(const std::string& address, const char* what) {
  throw InputError(fmt::format("{}: {}: {}", address, what, std::strerror(errno)));
}

/// Whether somebody listens at a socket's file. Asked with a socket of another kind, so that he does not take
/// it for a sender.
bool is_in_use(const sockaddr_un& place) {
  const Descriptor probe(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int result = connect(probe.get(), reinterpret_cast<const sockaddr*>(&place), sizeof(place));
  return result == 0 || errno == EPROTOTYPE;
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) close(number_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (number_ >= 0) close(number_);
  number_ = other.release();
  return *this;
}

LiveChannel::LiveChannel(const std::string& address) : wake_(eventfd(0, EFD_CLOEXEC)) {
  if (!wake_.is_open()) fail(address, "no event can be made");
  if (address == "-") {
    if (isatty(STDIN_FILENO) == 1)
      throw InputError(
          "--live -: standard input is a terminal; pipe a sender's stream into it (docs/live.md)");
    input_ = Descriptor(dup(STDIN_FILENO));
    if (!input_.is_open()) fail(address, "standard input cannot be read");
  } else if (address.starts_with("unix:")) {
    listen_unix(address.substr(5));
  } else if (address.starts_with("tcp:")) {
    listen_tcp(address, address.substr(4));
  } else {
    throw InputError(fmt::format("\"{}\" is no live source{}", address, kAddresses));
  }
}

LiveChannel::~LiveChannel() {
  remove_file();
}

void LiveChannel::listen_unix(const std::string& path) {
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  const std::string address = "unix:" + path;
  if (path.empty()) throw InputError(address + ": names no file" + kAddresses);
  if (path.size() >= sizeof(place.sun_path))
    throw InputError(fmt::format("{}: the path is too long for a socket; {} bytes are the most", address,
                                 sizeof(place.sun_path) - 1));
  path.copy(place.sun_path, sizeof(place.sun_path) - 1);
  if (std::error_code error; std::filesystem::is_socket(path, error)) {
    if (is_in_use(place)) throw InputError(address + ": another program listens there already");
    std::filesystem::remove(path, error);  // left by one that was killed
  }
  listener_ = Descriptor(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (bind(listener_.get(), reinterpret_cast<const sockaddr*>(&place), sizeof(place)) != 0)
    fail(address, "cannot be made");
  file_ = path;
  if (listen(listener_.get(), 1) != 0) fail(address, "cannot be listened at");
  listening_ = address;
}

void LiveChannel::listen_tcp(const std::string& address, const std::string& place) {
  const std::size_t colon = place.rfind(':');
  sockaddr_in where{};
  where.sin_family = AF_INET;
  const std::string host = place.substr(0, colon),
                    port = colon == std::string::npos ? "" : place.substr(colon + 1);
  const bool digits =
      !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::stoi(port) > 65535 || inet_pton(AF_INET, host.c_str(), &where.sin_addr) != 1)
    throw InputError(fmt::format("\"{}\" has no numeric address and port{}", address, kAddresses));
  where.sin_port = htons(static_cast<uint16_t>(std::stoi(port)));
  listener_ = Descriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  if (bind(listener_.get(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)) != 0 ||
      listen(listener_.get(), 1) != 0)
    fail(address, "cannot be listened at");
  socklen_t size = sizeof(where);
  getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&where), &size);
  listening_ = fmt::format("tcp:{}:{}", host, ntohs(where.sin_port));
}

/// Waits until there is something to read, or stop() was called, which it is false for.
bool LiveChannel::wait_readable(int descriptor) const {
  std::array<pollfd, 2> waited = {{{descriptor, POLLIN, 0}, {wake_.get(), POLLIN, 0}}};
  while (!stopped_) {
    if (poll(waited.data(), waited.size(), -1) < 0 && errno != EINTR) return false;
    if (waited[0].revents != 0) return !stopped_;
  }
  return false;
}

bool LiveChannel::wait_for_sender() {
  while (!input_.is_open()) {
    if (!wait_readable(listener_.get())) return false;
    // A sender that has gone again before it was taken is none.
    input_ = Descriptor(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!input_.is_open() && errno != ECONNABORTED && errno != EINTR) fail(listening_, "no sender is taken");
    if (!input_.is_open()) continue;
    const std::lock_guard lock(sending_);
    way_back_ = true;
  }
  listener_ = Descriptor();
  remove_file();
  return !stopped_;
}

void LiveChannel::remove_file() {
  if (file_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  file_.clear();
}

std::size_t LiveChannel::read(char* to, std::size_t most) {
  while (wait_readable(input_.get())) {
    const ssize_t got = ::read(input_.get(), to, most);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR && errno != EAGAIN) return 0;  // a sender that was torn off has gone
  }
  return 0;
}

void LiveChannel::stop() {
  stopped_ = true;
  const uint64_t one = 1;
  [[maybe_unused]] const auto ignored = write(wake_.get(), &one, sizeof(one));
}

bool LiveChannel::send(std::string_view text) {
  const std::lock_guard lock(sending_);
  if (!way_back_) return false;
  const bool fits = unsent_.size() + text.size() <= kMostUnsent;
  if (fits) unsent_ += text;  // whole lines or nothing
  while (!unsent_.empty()) {
    const ssize_t sent = ::send(input_.get(), unsent_.data(), unsent_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno != EAGAIN && errno != EWOULDBLOCK) way_back_ = false;
    if (sent <= 0) break;
    unsent_.erase(0, static_cast<std::size_t>(sent));
  }
  return fits && way_back_;
}

}  // namespace surefield
