#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace surefield {

/// Where a thread that a camera drives leaves what came last, and another takes it when it is ready: the
/// newest wins, and what nobody took in time is dropped. Every method may be called by any thread.
template <typename Item>
class NewestSlot {
 public:
  void put(Item item) {
    {
      const std::lock_guard lock(mutex_);
      if (ended_) return;
      if (item_) ++dropped_;
      item_ = std::move(item);
    }
    changed_.notify_all();
  }

  /// Waits for an item; nullopt where no more will come. Throws what close() was given, after the last item.
  std::optional<Item> take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || item_; });
    if (item_) return std::exchange(item_, std::nullopt);
    if (failure_) std::rethrow_exception(failure_);
    return std::nullopt;
  }

  /// No more will be put; what is there can be taken.
  void close(std::exception_ptr failure = nullptr) {
    {
      const std::lock_guard lock(mutex_);
      if (!ended_) failure_ = std::move(failure);
      ended_ = true;
    }
    changed_.notify_all();
  }

  /// Nobody wants any more: take() gives nothing, and waits no longer.
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
      item_.reset();
      failure_ = nullptr;
    }
    changed_.notify_all();
  }

  /// Items that a newer one has taken the place of.
  uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Item> item_;
  bool ended_ = false;
  uint64_t dropped_ = 0;
  std::exception_ptr failure_;
};

}  // namespace surefield
