// Sockets that a sender connects to.
#include "engine/sources/live_channel.h"

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <future>

#include "engine/sources/open_live.h"
#include "tests/support/input_files.h"
#include "tests/support/stream_writer.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// The other side of a socket at that address.
Descriptor connect_to(const std::string& address) {
  if (address.starts_with("unix:")) {
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    address.substr(5).copy(place.sun_path, sizeof(place.sun_path) - 1);
    Descriptor sender(socket(AF_UNIX, SOCK_STREAM, 0));
    REQUIRE(connect(sender.get(), reinterpret_cast<sockaddr*>(&place), sizeof(place)) == 0);
    return sender;
  }
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  Descriptor sender(socket(AF_INET, SOCK_STREAM, 0));
  REQUIRE(connect(sender.get(), reinterpret_cast<sockaddr*>(&place), sizeof(place)) == 0);
  return sender;
}

void write_all(const Descriptor& sender, const std::string& text) {
  REQUIRE(write(sender.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()));
}

std::string read_all(LiveChannel& channel) {
  std::string text;
  char piece[16];
  while (const std::size_t count = channel.read(piece, sizeof(piece))) text.append(piece, count);
  return text;
}

/// A folder whose path is short enough for a socket.
std::string socket_in(const TemporaryFolder& folder) {
  return "unix:" + (folder / "s").string();
}

}  // namespace

TEST_CASE("a sender's bytes come through either kind of socket, to its end, and answers go back") {
  const TemporaryFolder folder;
  for (const std::string& address : {socket_in(folder), std::string("tcp:127.0.0.1:0")}) {
    CAPTURE(address);
    LiveChannel channel(address);
    CHECK(channel.listening().starts_with(address.substr(0, 5)));
    CHECK_FALSE(channel.listening().ends_with(":0"));
    CHECK_FALSE(channel.send("nobody is there yet\n"));
    Descriptor sender = connect_to(channel.listening());
    REQUIRE(channel.wait_for_sender());
    CHECK_FALSE(std::filesystem::exists(folder / "s"));  // no second sender comes
    CHECK(channel.send("pose\n"));
    char answer[5];
    CHECK(read(sender.get(), answer, sizeof(answer)) == 5);
    CHECK(std::string(answer, 5) == "pose\n");
    write_all(sender, "forty two bytes of no meaning whatsoever..");
    sender = Descriptor();
    CHECK(read_all(channel) == "forty two bytes of no meaning whatsoever..");
    CHECK_FALSE(channel.stopped());
  }
}

TEST_CASE("a wait for a sender, and one for its bytes, ends by stop() from another thread") {
  const TemporaryFolder folder;
  {
    LiveChannel channel(socket_in(folder));
    auto waiting = std::async(std::launch::async, [&] { return channel.wait_for_sender(); });
    channel.stop();
    CHECK_FALSE(waiting.get());
    CHECK(std::filesystem::exists(folder / "s"));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "s"));
  LiveChannel channel(socket_in(folder));
  const Descriptor sender = connect_to(channel.listening());
  REQUIRE(channel.wait_for_sender());
  auto waiting = std::async(std::launch::async, [&] { return read_all(channel); });
  channel.stop();
  CHECK(waiting.get() == "");
}

TEST_CASE("a sender that does not read is not waited for, and one that is gone is no fault") {
  const TemporaryFolder folder;
  LiveChannel channel(socket_in(folder));
  Descriptor sender = connect_to(channel.listening());
  REQUIRE(channel.wait_for_sender());
  const std::string line(10000, 'x');
  int taken = 0;
  while (channel.send(line)) ++taken;
  CHECK(taken >= 100);  // a megabyte waits here, beside what the system keeps
  CHECK(taken < 10000);
  sender = Descriptor();
  CHECK_FALSE(channel.send(line));
  CHECK(read_all(channel) == "");
}

TEST_CASE("the socket of a program that was killed is taken over, that of one that lives is not") {
  const TemporaryFolder folder;
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  (folder / "s").string().copy(place.sun_path, sizeof(place.sun_path) - 1);
  {
    const Descriptor killed(socket(AF_UNIX, SOCK_STREAM, 0));
    REQUIRE(bind(killed.get(), reinterpret_cast<sockaddr*>(&place), sizeof(place)) == 0);
  }
  LiveChannel channel(socket_in(folder));
  CHECK(contains(input_error([&] { LiveChannel(socket_in(folder)); }), "another program listens there"));
  // Which has not been taken for a sender.
  const Descriptor sender = connect_to(channel.listening());
  REQUIRE(channel.wait_for_sender());
  CHECK(channel.send("x"));
}

TEST_CASE("addresses that are none are refused with what there is") {
  const TemporaryFolder folder;
  for (const char* address : {"", "webcam", "tcp:127.0.0.1", "tcp:localhost:80", "tcp:127.0.0.1:70000",
                              "tcp:1.2.3:5", "tcp:127.0.0.1:-1", "unix:"}) {
    CAPTURE(address);
    CHECK(contains(input_error([&] { LiveChannel channel((std::string(address))); }), "tcp:127.0.0.1:PORT"));
  }
  CHECK(contains(input_error([&] { LiveChannel("unix:" + std::string(200, 'a')); }), "too long"));
  CHECK(contains(input_error([&] { LiveChannel("unix:/no/such/folder/s"); }), "/no/such/folder/s"));
  const auto file = folder.write("file", "mine");
  CHECK(contains(input_error([&] { LiveChannel("unix:" + file.string()); }), "cannot be made"));
  CHECK(std::filesystem::file_size(file) == 4);
}

TEST_CASE("a live source says where it waits, and opens when a stream has begun") {
  const TemporaryFolder folder;
  std::promise<std::string> place;
  const LiveOptions options{.waiting = [&](const std::string& at) { place.set_value(at); }};
  auto opening = std::async(std::launch::async, [&] { return open_live(socket_in(folder), options); });
  const Descriptor sender = connect_to(place.get_future().get());
  HeaderToSend header;
  header.flags = 1;
  write_all(sender, header.message() + FrameToSend().message() + end_message());
  const LiveSource live = opening.get();
  REQUIRE(live.source);
  CHECK(live.stream == live.source.get());
  CHECK(live.source->next());
  CHECK_FALSE(live.source->next());
}

TEST_CASE("opening a live source can be given up") {
  const TemporaryFolder folder;
  std::stop_source stop;
  const LiveOptions options{.stop = stop.get_token(),
                            .waiting = [&](const std::string&) { stop.request_stop(); }};
  CHECK(open_live(socket_in(folder), options).source == nullptr);
}
