#pragma once

#include "engine/slam/slam_implementation.h"
#include "engine/types/error.h"

namespace surefield {

/// The time in which one thread feeds, finishes or changes, alone.
class Slam::Turn {
 public:
  explicit Turn(Implementation& implementation) : s_(implementation) {
    if (s_.at_turn == std::this_thread::get_id())
      throw UsageError("a function that SLAM calls may not feed, finish or change it");
    s_.turns.lock();
    s_.at_turn = std::this_thread::get_id();
    s_.state.lock();
    revision_before_ = s_.revision;
  }
  ~Turn() {
    s_.state.unlock();
    s_.at_turn = std::thread::id();
    s_.turns.unlock();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  /// Tells the pose of the frame that was added last; where that fails the frame is taken back out.
  void tell_tracked(const Tracked& tracked) {
    if (!tracked) return;
    const FrameReport report = s_.history.last_report();
    try {
      const Outside outside(s_.state);
      tracked(report);
    } catch (...) {
      s_.history.drop_last();
      throw;
    }
  }

  /// Tells the listener where the revision has changed in this turn.
  void tell_revision() noexcept {
    const uint64_t revision = s_.revision;
    if (revision == revision_before_ || !s_.listener) return;
    const Outside outside(s_.state);
    s_.listener(revision);
  }

 private:
  /// The time in which a function of the caller runs, and others may read.
  class Outside {
   public:
    explicit Outside(FairMutex& mutex) : mutex_(mutex) { mutex_.unlock(); }
    ~Outside() { mutex_.lock(); }
    Outside(const Outside&) = delete;
    Outside& operator=(const Outside&) = delete;

   private:
    FairMutex& mutex_;
  };

  Implementation& s_;
  uint64_t revision_before_ = 0;
};

}  // namespace surefield
