#include "tools/shared/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "tools/shared/command.h"

namespace surefield {

namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int) {
  if (stop_requested.exchange(true)) _exit(kInterrupted);
  constexpr char kMessage[] = "\nStopping after this frame; everything will be saved (again: quit at once)\n";
  // Nothing can be done about a closed stderr.
  [[maybe_unused]] const auto ignored = write(STDERR_FILENO, kMessage, sizeof(kMessage) - 1);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void interrupt() {
  stop_requested = true;
}

bool interrupted() {
  return stop_requested;
}

}  // namespace surefield
