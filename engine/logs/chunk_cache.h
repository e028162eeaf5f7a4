#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace surefield {

/// The chunks that were unpacked last, since messages that follow each other lie in the same ones. May be
/// used by any threads.
class ChunkCache {
 public:
  using Chunk = std::shared_ptr<const std::string>;

  /// The unpacked chunk at `at`, by `load()` where it is not held.
  template <typename Load>
  Chunk get(uint64_t at, Load load) {
    {
      const std::lock_guard lock(mutex_);
      for (auto held = held_.begin(); held != held_.end(); ++held) {
        if (held->first != at) continue;
        held_.splice(held_.begin(), held_, held);
        return held->second;
      }
    }
    Chunk chunk = std::make_shared<const std::string>(load());
    const std::lock_guard lock(mutex_);
    held_.emplace_front(at, chunk);
    bytes_ += chunk->size();
    while (held_.size() > 1 && bytes_ > kMostBytes) {
      bytes_ -= held_.back().second->size();
      held_.pop_back();
    }
    return chunk;
  }

 private:
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  std::mutex mutex_;
  std::list<std::pair<uint64_t, Chunk>> held_;
  std::size_t bytes_ = 0;
};

}  // namespace surefield
