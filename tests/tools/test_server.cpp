#include "tests/tools/test_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace surefield::test {

namespace {

void send_all(int connection, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const auto count = send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return;
    sent += static_cast<std::size_t>(count);
  }
}

std::string read_request(int connection) {
  std::string request;
  char bytes[4096];
  while (request.find("\r\n\r\n") == std::string::npos) {
    const auto count = recv(connection, bytes, sizeof(bytes), 0);
    if (count <= 0) break;
    request.append(bytes, static_cast<std::size_t>(count));
  }
  return request;
}

std::string range_of(const std::string& request) {
  const std::string key = "Range: ";
  const auto start = request.find(key);
  if (start == std::string::npos) return {};
  return request.substr(start + key.size(), request.find("\r\n", start) - start - key.size());
}

}  // namespace

TestServer::TestServer(ServerBehaviour behaviour) : behaviour_(std::move(behaviour)) {
  socket_ = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(socket_, 8) != 0 ||
      getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("the test server cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

TestServer::~TestServer() {
  stopping_ = true;
  shutdown(socket_, SHUT_RDWR);  // wakes accept()
  thread_.join();
  close(socket_);
}

std::string TestServer::url(const std::string& name) const {
  return fmt::format("http://127.0.0.1:{}/{}", port_, name);
}

std::vector<std::string> TestServer::ranges() const {
  const std::lock_guard lock(mutex_);
  return ranges_;
}

void TestServer::serve() {
  while (!stopping_) {
    const int connection = accept(socket_, nullptr, nullptr);
    if (connection < 0) continue;
    answer(connection);
    close(connection);
  }
}

void TestServer::answer(int connection) {
  const std::string range = range_of(read_request(connection));
  {
    const std::lock_guard lock(mutex_);
    ranges_.push_back(range);
  }
  const std::string& body = behaviour_.body;
  std::size_t start = 0;
  if (behaviour_.ranges && range.starts_with("bytes=")) start = std::stoul(range.substr(6));
  if (behaviour_.status != 200 || start >= body.size()) {
    const int status = behaviour_.status != 200 ? behaviour_.status : 416;
    return send_all(connection,
                    fmt::format("HTTP/1.1 {} No\r\nContent-Length: 0\r\nConnection: close\r\n\r\n", status));
  }
  std::string head = start > 0 ? fmt::format("HTTP/1.1 206 Partial\r\nContent-Range: bytes {}-{}/{}\r\n",
                                             start, body.size() - 1, body.size())
                               : std::string("HTTP/1.1 200 OK\r\n");
  head += fmt::format("Content-Length: {}\r\nConnection: close\r\n\r\n", body.size() - start);
  const bool cut = behaviour_.cuts > 0 && behaviour_.cuts-- > 0;
  send_all(connection, head + body.substr(start, cut ? behaviour_.cut_after : std::string::npos));
}

}  // namespace surefield::test
