#include "tools/shared/interrupt.h"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr int kPatience = 1500;  // milliseconds in which the program may stop by itself

std::atomic<int> signals{0};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<int, 2> wake_up{
    -1, -1};  // a pipe from the handler, which may do next to nothing, to the watching thread

std::stop_source stop;
std::mutex ending;  ///< guards what follows
bool something_to_lose = false;
std::function<void()> clean_up;

extern "C" void on_interrupt(int) {
  if (signals.fetch_add(1) > 0) _exit(kInterrupted);
  [[maybe_unused]] const auto ignored = write(wake_up[1], "", 1);
}

void tell(std::string_view message) {
  // Nothing can be done about a closed stderr.
  [[maybe_unused]] const auto ignored = write(STDERR_FILENO, message.data(), message.size());
}

bool has_something_to_lose() {
  const std::lock_guard lock(ending);
  return something_to_lose;
}

/// The thread that waits for the first signal, and for what the program makes of it.
void watch() {
  char byte;
  while (read(wake_up[0], &byte, 1) != 1) {
  }
  tell(has_something_to_lose() ? "\nStopping; everything so far will be saved (again: quit at once)\n"
                               : "\nStopping\n");
  stop.request_stop();
  poll(nullptr, 0, kPatience);
  const std::lock_guard lock(ending);
  if (something_to_lose) return;
  if (clean_up) clean_up();
  _exit(kInterrupted);
}

void handle(int number) {
  struct sigaction action = {};
  sigaction(number, nullptr, &action);
  if (number == SIGHUP && action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  sigaction(number, &action, nullptr);
}

}  // namespace

void catch_interrupts() {
  static const bool caught = [] {
    if (pipe(wake_up.data()) != 0) return false;  // Ctrl-C ends the program then, as it does others
    std::thread(watch).detach();
    for (int number : {SIGINT, SIGTERM, SIGHUP}) handle(number);
    return true;
  }();
  static_cast<void>(caught);
}

void interrupt() {
  stop.request_stop();
}

bool interrupted() {
  return stop.stop_requested();
}

std::stop_token interruption() {
  return stop.get_token();
}

void clean_up_when_ended(std::function<void()> what) {
  const std::lock_guard lock(ending);
  clean_up = std::move(what);
}

void keep_until_saved() {
  const std::lock_guard lock(ending);
  something_to_lose = true;
  clean_up = nullptr;
}

void leave(int code) {
  std::fflush(nullptr);
  _exit(code);
}

}  // namespace surefield
