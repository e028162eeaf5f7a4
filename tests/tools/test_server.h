#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace surefield::test {

/// How the server answers.
struct ServerBehaviour {
  std::string body;    ///< of every file
  bool ranges = true;  ///< whether it knows the Range header
  int cuts = 0;        ///< the first so many answers end after `cut_after` bytes of the body
  std::size_t cut_after = 0;
  int status = 200;  ///< another one is answered without the body
};

/// An HTTP server on this machine, with one file. Answers one request after the other.
class TestServer {
 public:
  explicit TestServer(ServerBehaviour behaviour);
  ~TestServer();
  TestServer(const TestServer&) = delete;
  TestServer& operator=(const TestServer&) = delete;

  /// The address of a file of this name.
  std::string url(const std::string& name) const;
  /// The Range header of each request so far; empty where it had none.
  std::vector<std::string> ranges() const;

 private:
  void serve();
  void answer(int connection);

  ServerBehaviour behaviour_;
  int socket_ = -1;
  int port_ = 0;
  std::atomic<bool> stopping_ = false;
  mutable std::mutex mutex_;
  std::vector<std::string> ranges_;
  std::thread thread_;
};

}  // namespace surefield::test
