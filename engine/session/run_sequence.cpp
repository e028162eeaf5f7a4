#include "engine/session/run_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <new>

#include "engine/slam/slam_thread.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// Whether an error is no matter of one frame.
bool ends_run(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const DeviceError&) {
    return true;
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
}

/// What the thread of SLAM tells of a run, passed on to the observers with the frames that were skipped.
class Listener : public SlamListener {
 public:
  Listener(const RunObservers& observers, const std::stop_token& stop) : observers_(observers), stop_(stop) {}

  bool before_frame(Slam& slam) override {
    return guard([&] {
      for (RunObserver* observer : observers_)
        if (!is_interrupted()) observer->before_frame(slam);
      return !is_interrupted();
    });
  }

  void tracked(const Frame& frame, const FrameReport& report) override {
    for (RunObserver* observer : observers_) observer->tracked(frame, report);
  }

  void mapped(const Frame& frame, const Slam& slam, const FrameReport& report) override {
    guard([&] {
      tell_unreadable(frame.index);
      any_fed_ = true;
      for (RunObserver* observer : observers_) observer->fed(frame, slam, report);
      count_done();
      return true;
    });
  }

  void failed(const Frame& frame, const Slam& slam, const std::exception_ptr& error) override {
    guard([&] {
      tell_unreadable(frame.index);
      if (ends_run(error) || !slam.usable()) std::rethrow_exception(error);
      skip({frame.index, describe(error)});
      count_unusable(error);
      count_done();
      return true;
    });
  }

  /// Called by the thread that reads: waits until so many frames were fed or failed, or the thread takes no
  /// more.
  void wait_for_done(std::size_t frames) {
    std::unique_lock lock(mutex_);
    progress_.wait(lock, [&] { return done_ >= frames || ended_; });
  }

  bool any_fed() const { return any_fed_; }
  bool is_interrupted() const { return stop_.stop_requested(); }
  /// Whether the thread takes no more frames; asked by the thread that reads.
  bool ended() const { return ended_; }

  /// Called by the thread that reads: frames that the source has passed over.
  void note_unreadable(const std::vector<SkippedFrame>& problems) {
    const std::lock_guard lock(mutex_);
    unreadable_.insert(unreadable_.end(), problems.begin() + static_cast<std::ptrdiff_t>(unreadable_.size()),
                       problems.end());
  }

  /// Gives up after the first frames that cannot be fed. One that is dark only says nothing of the next one.
  void count_unusable(const std::exception_ptr& error) {
    try {
      std::rethrow_exception(error);
    } catch (const NoImageError&) {
      return;
    } catch (...) {
    }
    if (++unusable_ >= kHopelessFrames && !any_fed_) throw InputError(hopeless());
  }

  /// Why no frame could be used; empty where one could, or none came.
  std::string hopeless() const {
    if (any_fed_ || skipped_.empty()) return {};
    return fmt::format("none of the {} frames so far can be used: {}", skipped_.size(),
                       skipped_.front().reason);
  }

  /// Tells the observers of unreadable frames up to an index.
  void tell_unreadable(int up_to) {
    std::vector<SkippedFrame> due;
    {
      const std::lock_guard lock(mutex_);
      while (told_ < unreadable_.size() && unreadable_[told_].index < up_to)
        due.push_back(unreadable_[told_++]);
    }
    for (const SkippedFrame& frame : due) skip(frame);
  }

  std::vector<SkippedFrame> take_skipped() {
    std::sort(skipped_.begin(), skipped_.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
    return std::move(skipped_);
  }

 private:
  /// Does `work` and returns what it returns, whether to go on; notes the end where it says no or throws.
  template <typename Work>
  bool guard(Work work) {
    try {
      if (work()) return true;
    } catch (...) {
      end();
      throw;
    }
    end();
    return false;
  }

  void end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    progress_.notify_all();
  }

  void count_done() {
    {
      const std::lock_guard lock(mutex_);
      ++done_;
    }
    progress_.notify_all();
  }

  void skip(const SkippedFrame& frame) {
    skipped_.push_back(frame);
    for (RunObserver* observer : observers_) observer->skipped(frame);
  }

  const RunObservers& observers_;
  const std::stop_token stop_;
  bool any_fed_ = false;
  std::size_t unusable_ = 0;
  std::vector<SkippedFrame> skipped_;
  std::atomic<bool> ended_{false};

  std::mutex mutex_;  ///< guards what follows
  std::vector<SkippedFrame> unreadable_;
  std::size_t told_ = 0;
  std::size_t done_ = 0;  ///< frames that were fed or failed
  std::condition_variable progress_;
};

/// The source's next frame. Where it throws, what it gave before is fed first: `fed` frames.
std::optional<Frame> next_of(FrameSource& source, Listener& listener, std::size_t fed) {
  try {
    return source.next();
  } catch (...) {
    listener.wait_for_done(fed);
    throw;
  }
}

/// Has the thread feed all frames of the source and finish, unless it ends before.
void feed_all(FrameSource& source, SlamThread& thread, Listener& listener) {
  const bool live = source.live().has_value();
  std::size_t fed = 0;
  while (!listener.is_interrupted()) {
    std::optional<Frame> frame = next_of(source, listener, fed);
    listener.note_unreadable(source.problems());
    if (!frame && listener.is_interrupted()) break;
    if (!frame) return thread.finish();
    thread.feed(std::move(*frame));
    ++fed;
    // A frame that is taken early is old when its turn comes, while newer ones are dropped.
    if (live) listener.wait_for_done(fed);
    if (listener.ended()) return thread.finish();  // throws what has ended it
  }
  thread.stop();
}

}  // namespace

SequenceRun run_sequence(FrameSource& source, Slam& slam, const RunObservers& observers,
                         const std::stop_token& stop) {
  SequenceRun run;
  Listener listener(observers, stop);
  const std::stop_callback end_soon(stop, [&] {
    slam.stop_mapping();
    source.stop();
  });
  const auto start = std::chrono::steady_clock::now();
  try {
    // The source decodes ahead where that pays; more frames waiting here would only take memory.
    SlamThread thread(slam, {.policy = QueuePolicy::Block, .capacity = 1}, &listener);
    feed_all(source, thread, listener);
  } catch (...) {
    if (!listener.is_interrupted() || !slam.usable()) run.failure = std::current_exception();
  }
  // Of a source that is given up the error says it all.
  if (!run.failure || listener.any_fed()) listener.tell_unreadable(std::numeric_limits<int>::max());
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string hopeless = listener.hopeless();
  if (!run.failure && !hopeless.empty() && !stop.stop_requested())
    run.failure = std::make_exception_ptr(InputError(hopeless));
  run.skipped = listener.take_skipped();
  run.end = run.failure                 ? RunEnd::Failed
            : listener.is_interrupted() ? RunEnd::Interrupted
                                        : RunEnd::Completed;
  return run;
}

}  // namespace surefield
