#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace surefield {

/// A mutex that lets threads in in the order in which they asked: one that takes it again at once, as a
/// thread does that feeds frame after frame, does not shut the others out.
class FairMutex {
 public:
  void lock() {
    std::unique_lock lock(mutex_);
    const uint64_t turn = asked_++;
    passed_.wait(lock, [&] { return turn == served_; });
  }
  void unlock() {
    {
      const std::lock_guard lock(mutex_);
      ++served_;
    }
    passed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable passed_;
  uint64_t asked_ = 0;   ///< turns that were given out
  uint64_t served_ = 0;  ///< the turn whose thread is in, or may enter
};

}  // namespace surefield
