#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <optional>
#include <thread>

#include "engine/slam/slam.h"
#include "engine/types/frame.h"

namespace surefield {

/// What becomes of a frame that is fed while as many wait as may.
enum class QueuePolicy {
  Block,       ///< feed() waits; no frame is lost
  NewestWins,  ///< the one that has waited the longest is dropped
};

/// How a SlamThread takes frames in.
struct SlamThreadOptions {
  QueuePolicy policy = QueuePolicy::Block;
  std::size_t capacity = 2;  ///< frames that may wait, beside the one in work; at least 1
};

/// What may watch the frames of a SlamThread, and steer it. All calls come from the thread that runs SLAM,
/// and none may call SlamThread::finish(). An exception out of before_frame(), mapped() or failed() ends the
/// thread, as an error in the middle of mapping does.
class SlamListener {
 public:
  virtual ~SlamListener() = default;

  /// A frame waits, and is about to be taken. May wait and change settings. Returns whether to go on: false
  /// does what stop() does.
  virtual bool before_frame(Slam&) { return true; }
  /// Its pose is known, and its future is about to be; see Slam::Tracked for what may be called.
  virtual void tracked(const Frame&, const FrameReport&) {}
  /// It was fed, and the map has it.
  virtual void mapped(const Frame&, const Slam&, const FrameReport&) {}
  /// Feeding it has thrown this. The thread goes on where Slam::usable().
  virtual void failed(const Frame&, const Slam&, const std::exception_ptr&) {}
};

/// Runs SLAM on a thread of its own: feed() returns at once, and gives the pose when tracking is done, while
/// mapping goes on. The next frame waits for mapping, so the results are those of Slam::feed(), bit for bit.
///
///   Slam slam(settings, intrinsics);
///   SlamThread thread(slam, {.policy = QueuePolicy::NewestWins});
///   while (auto frame = camera.next()) show(thread.feed(*frame));
///   thread.finish();
///
/// Threads: every method may be called from any thread, and so may those of the Slam, which waits for the
/// frame in work; nobody else feeds or finishes it.
class SlamThread {
 public:
  /// `slam` and `listener` (which may be null) outlive this. Throws UsageError where `options` let no frame
  /// wait.
  explicit SlamThread(Slam& slam, const SlamThreadOptions& options = {}, SlamListener* listener = nullptr);
  /// As stop().
  ~SlamThread();
  SlamThread(const SlamThread&) = delete;
  SlamThread& operator=(const SlamThread&) = delete;

  /// Has the frame wait its turn; nobody writes to its images afterwards. The future has the report of
  /// Slam::Tracked once the pose is known; nothing, if the frame was dropped; or the error for which it was
  /// not fed. After finish(), stop() or an error that ended the thread, that is at once a StateError or that
  /// error.
  std::future<std::optional<FrameReport>> feed(Frame frame);

  /// Feeds what waits, finishes the Slam and ends the thread. Throws the error that has ended it before, or
  /// that finishing ended with, or StateError after stop().
  void finish();

  /// Ends the thread after the frame in work; frames that wait are dropped. The Slam is not finished. Called
  /// by the listener, it returns before the thread has ended.
  void stop();

  /// Frames that were dropped so far.
  uint64_t dropped() const;
  /// Frames that wait now.
  std::size_t waiting() const;

 private:
  struct Waiting {
    Frame frame;
    std::promise<std::optional<FrameReport>> result;
  };
  void run() noexcept;
  void serve();
  std::optional<Waiting> take();
  void work(Waiting waiting);
  void drop_oldest();
  void close(const std::exception_ptr& end);
  void join();
  bool is_own_thread() const { return serving_ == std::this_thread::get_id(); }

  Slam& slam_;
  const SlamThreadOptions options_;
  SlamListener* const listener_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;  ///< of the thread: there is a frame, or an end is wanted
  std::condition_variable room_;  ///< of feed(): a frame was taken, or there is an end
  std::deque<Waiting> queue_;
  uint64_t dropped_ = 0;
  bool finish_wanted_ = false;
  bool stop_wanted_ = false;
  bool finished_ = false;   ///< the thread has fed all and finished the Slam
  std::exception_ptr end_;  ///< why the thread takes no more frames; null: it does

  std::mutex joining_;
  std::atomic<std::thread::id> serving_;  ///< the thread's, once it runs
  std::thread thread_;
};

}  // namespace surefield
