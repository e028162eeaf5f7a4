#include "engine/sources/timed_replay.h"

#include <fmt/format.h>

#include <utility>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kAssumedRate = 30;  // frames a second of a recording that has only numbers

}  // namespace

TimedReplay::TimedReplay(const Recording& recording, double speed) : recording_(recording) {
  numbered_ = recording.count() > 1;
  for (int i = 0; i < recording.count(); ++i) {
    const double stamp = recording.timestamp(i);
    if (i > 0 && stamp < recording.timestamp(i - 1))
      throw InputError(
          fmt::format("{} cannot be replayed at its own speed: the stamp of frame {} lies before that of "
                      "the frame before it",
                      recording.name(), i));
    numbered_ = numbered_ && stamp == static_cast<double>(static_cast<int64_t>(stamp)) && stamp < 1e6;
    seconds_.push_back(stamp - recording.timestamp(0));
  }
  for (double& seconds : seconds_) seconds /= numbered_ ? speed * kAssumedRate : speed;
}

std::vector<std::string> TimedReplay::assumptions() const {
  std::vector<std::string> lines = recording_.assumptions();
  if (numbered_)
    lines.push_back(
        fmt::format("its frames are numbered and have no stamps: {:.0f} come a second", kAssumedRate));
  return lines;
}

TimedReplay::Clock::time_point TimedReplay::due(int i) const {
  return *begin_ + std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>(seconds_[static_cast<std::size_t>(i)]));
}

/// False where stop() was called.
bool TimedReplay::wait_until(Clock::time_point moment) {
  std::unique_lock lock(mutex_);
  return !ending_.wait_until(lock, moment, [&] { return stopped_; });
}

/// Waits for the next frame and takes the newest that has arrived; nullopt after the last.
std::optional<int> TimedReplay::newest_due() {
  if (next_ == recording_.count() || !wait_until(due(next_))) return std::nullopt;
  const Clock::time_point now = Clock::now();
  arrivals_.add(due(next_));
  while (next_ + 1 < recording_.count() && due(next_ + 1) <= now) {
    arrivals_.add(due(++next_));
    ++dropped_;
  }
  return next_++;
}

std::optional<Frame> TimedReplay::next() {
  if (!begin_) begin_ = Clock::now();
  while (const std::optional<int> i = newest_due()) {
    LoadedFrame loaded = recording_.load(*i);
    if (loaded.frame) {
      loaded.frame->arrived = due(*i);
      return std::move(loaded.frame);
    }
    problems_.push_back({*i, std::move(loaded.problem)});
  }
  return std::nullopt;
}

void TimedReplay::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  ending_.notify_all();
}

}  // namespace surefield
