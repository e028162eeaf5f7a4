// Sends frames of one's own to surefield run --live unix:PATH and prints the poses that come back: what a
// program does that has a camera's driver and no room for Surefield in it. No library; the frames are made
// up.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

template <typename... Numbers>
static std::string bytes(Numbers... numbers) {  // little endian, as the stream (docs/live.md)
  std::string text;
  (text.append(reinterpret_cast<const char*>(&numbers), sizeof(numbers)), ...);
  return text;
}

static bool send_message(int to, const char* tag, const std::string& body) {
  const std::string text = tag + bytes(static_cast<uint32_t>(body.size())) + body;
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t sent = send(to, text.data() + at, text.size() - at, MSG_NOSIGNAL);
    if (sent <= 0) return false;  // the receiver has ended
    at += static_cast<std::size_t>(sent);
  }
  return true;
}

static double now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

int main(int count, char** arguments) {
  sockaddr_un place{AF_UNIX, {}};
  if (count != 3) return std::fprintf(stderr, "usage: send_camera SOCKET FRAMES\n"), 2;
  std::strncpy(place.sun_path, arguments[1], sizeof(place.sun_path) - 1);
  const int to = socket(AF_UNIX, SOCK_STREAM, 0), width = 160, height = 120;
  if (connect(to, reinterpret_cast<sockaddr*>(&place), sizeof(place)) != 0)
    return std::perror(arguments[1]), 1;
  const double fx = 140, fy = 140, cx = 79.5, cy = 59.5;
  const uint32_t flags = 2 | 4;  // poses are to come back; stamps are of this machine's clock
  send_message(to, "SFLH",
               bytes(1u, flags, static_cast<uint32_t>(width), static_cast<uint32_t>(height), fx, fy, cx, cy,
                     0.001, 0u, 0u) +
                   std::string(14 * 8, '\0') + std::string("wall").append(60, '\0'));
  std::thread listener([&] {  // a sender that asks for poses reads them
    char piece[4096];
    for (ssize_t got; (got = read(to, piece, sizeof(piece))) > 0; std::fflush(stdout))
      std::fwrite(piece, 1, static_cast<std::size_t>(got), stdout);
  });
  std::vector<uint8_t> colour(3 * width * height);
  std::vector<uint16_t> depth(width * height);
  for (int i = 0; i < std::stoi(arguments[2]); ++i) {
    for (int k = 0; k < width * height; ++k) {  // a painted wall, 1.6 m away, along which the camera slides
      const double x = (k % width - cx) / fx * 1.6 + 0.005 * i, y = (k / width - cy) / fy * 1.6;
      for (int c = 0; c < 3; ++c)
        colour[3 * k + c] =
            static_cast<uint8_t>(128 + 90 * std::sin((9 + 4 * c) * x) * std::cos((13 - 3 * c) * y));
      depth[k] = 1600;
    }
    const double stamp = now();
    std::string body = bytes(0u, 0u, stamp, stamp, static_cast<uint32_t>(colour.size()),
                             static_cast<uint32_t>(2 * depth.size()));
    body.append(colour.begin(), colour.end())
        .append(reinterpret_cast<const char*>(depth.data()), 2 * depth.size());
    if (!send_message(to, "SFLF", body)) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(33));
  }
  send_message(to, "SFLE", "");
  shutdown(to, SHUT_WR);
  listener.join();
  return close(to);
}
