#include "engine/slam/slam_thread.h"

#include <utility>

#include "engine/types/error.h"

namespace surefield {

namespace {

std::exception_ptr ended(const char* message) {
  return std::make_exception_ptr(StateError(message));
}

}  // namespace

SlamThread::SlamThread(Slam& slam, const SlamThreadOptions& options, SlamListener* listener)
    : slam_(slam), options_(options), listener_(listener) {
  if (options.capacity < 1) throw UsageError("the queue of a SLAM thread needs room for a frame");
  thread_ = std::thread([this] { run(); });
}

SlamThread::~SlamThread() {
  stop();
}

std::future<std::optional<FrameReport>> SlamThread::feed(Frame frame) {
  Waiting waiting{std::move(frame), {}};
  std::future<std::optional<FrameReport>> result = waiting.result.get_future();
  std::unique_lock lock(mutex_);
  const auto closed = [&] { return end_ || finish_wanted_ || stop_wanted_; };
  if (options_.policy == QueuePolicy::Block)
    room_.wait(lock, [&] { return closed() || queue_.size() < options_.capacity; });
  if (closed()) {
    waiting.result.set_exception(end_ ? end_ : ended("the SLAM thread takes no more frames: it is ending"));
    return result;
  }
  if (queue_.size() == options_.capacity) drop_oldest();
  queue_.push_back(std::move(waiting));
  lock.unlock();
  wake_.notify_one();
  return result;
}

void SlamThread::finish() {
  if (is_own_thread()) throw UsageError("a SLAM thread's listener may not finish it");
  {
    const std::lock_guard lock(mutex_);
    finish_wanted_ = true;
  }
  wake_.notify_one();
  room_.notify_all();
  join();
  const std::lock_guard lock(mutex_);
  if (!finished_) std::rethrow_exception(end_);
}

void SlamThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_wanted_ = true;
    while (!queue_.empty()) drop_oldest();
  }
  wake_.notify_one();
  room_.notify_all();
  join();
}

uint64_t SlamThread::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

std::size_t SlamThread::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

/// The thread.
void SlamThread::run() noexcept {
  serving_ = std::this_thread::get_id();
  try {
    serve();
  } catch (...) {
    close(std::current_exception());
  }
}

/// Feeds frame after frame until an end is wanted; throws the error that ends it all.
void SlamThread::serve() {
  while (std::optional<Waiting> waiting = take()) work(std::move(*waiting));
  {
    const std::lock_guard lock(mutex_);
    if (stop_wanted_) throw StateError("the SLAM thread was stopped");
  }
  slam_.finish();
  const std::lock_guard lock(mutex_);
  finished_ = true;
  end_ = ended("the SLAM thread has finished");
}

/// Waits for the next frame; none where an end is wanted.
std::optional<SlamThread::Waiting> SlamThread::take() {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return stop_wanted_ || finish_wanted_ || !queue_.empty(); });
  if (queue_.empty()) return std::nullopt;
  if (listener_) {
    lock.unlock();
    const bool goes_on = listener_->before_frame(slam_);
    lock.lock();
    if (!goes_on) stop_wanted_ = true;
  }
  if (stop_wanted_) {
    while (!queue_.empty()) drop_oldest();
    return std::nullopt;
  }
  Waiting waiting = std::move(queue_.front());
  queue_.pop_front();
  lock.unlock();
  room_.notify_one();
  return waiting;
}

/// Feeds one frame. Its future has the pose or the error; where SLAM is not usable afterwards the error is
/// thrown too.
void SlamThread::work(Waiting waiting) {
  bool told = false;
  FrameReport report;
  try {
    report = slam_.feed(waiting.frame, [&](const FrameReport& tracked) {
      if (listener_) listener_->tracked(waiting.frame, tracked);
      waiting.result.set_value(tracked);
      told = true;
    });
  } catch (...) {
    const std::exception_ptr error = std::current_exception();
    if (!told) waiting.result.set_exception(error);
    if (listener_) listener_->failed(waiting.frame, slam_, error);
    if (!slam_.usable()) throw;
    return;
  }
  if (listener_) listener_->mapped(waiting.frame, slam_, report);
}

/// Drops the frame that has waited the longest; the caller holds the mutex.
void SlamThread::drop_oldest() {
  queue_.front().result.set_value(std::nullopt);
  queue_.pop_front();
  ++dropped_;
}

/// The thread ends with this error, which those that wait get.
void SlamThread::close(const std::exception_ptr& end) {
  {
    const std::lock_guard lock(mutex_);
    end_ = end;
    for (Waiting& waiting : queue_) waiting.result.set_exception(end);
    queue_.clear();
  }
  room_.notify_all();
}

void SlamThread::join() {
  if (is_own_thread()) return;
  const std::lock_guard lock(joining_);
  if (thread_.joinable()) thread_.join();
}

}  // namespace surefield
