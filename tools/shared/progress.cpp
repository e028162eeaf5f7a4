#include "tools/shared/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "tools/shared/progress_line.h"
#include "tools/shared/say.h"

namespace surefield {

namespace {

constexpr int kNamedFrames = 5;  // that are skipped; more would push everything else off the screen
constexpr const char* kClearLine = "\r\x1b[K";
constexpr int kCountedLines = 100;  // frames to a line where nobody knows how many there will be

}  // namespace

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Progress::Progress(std::optional<int> frames, bool quiet)
    : frames_(frames ? std::optional(std::max(1, *frames)) : std::nullopt),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {
  if (quiet_) return;
  if (terminal_) {
    draw();
    ticker_ = std::thread([this] { tick(); });
  } else {
    say(stderr, "{}\n", numbers());
  }
}

Progress::~Progress() {
  if (!ticker_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ending_.notify_all();
  ticker_.join();
  say(stderr, "\n");
}

/// Draws every second, so that the first frame, which may take long, is seen to be at work.
void Progress::tick() {
  std::unique_lock lock(mutex_);
  while (!ending_.wait_for(lock, std::chrono::seconds(1), [this] { return ended_; })) draw();
}

void Progress::fed(const Frame&, const Slam&, const FrameReport& report) {
  const std::lock_guard lock(mutex_);
  last_ = report;
  if (++fed_ > 1) pace_.add(seconds_since(last_end_));
  last_end_ = std::chrono::steady_clock::now();
  advance();
}

void Progress::skipped(const SkippedFrame& frame) {
  const std::lock_guard lock(mutex_);
  ++skipped_;
  const char* before = terminal_ ? kClearLine : "";
  if (!quiet_ && skipped_ <= kNamedFrames)
    say(stderr, "{}skipped: frame {}: {}\n", before, frame.index, frame.reason);
  if (!quiet_ && skipped_ == kNamedFrames + 1)
    say(stderr, "{}skipped: others too; log.txt names them\n", before);
  advance();
}

void Progress::advance() {
  ++done_;
  if (quiet_) return;
  if (terminal_) {
    draw();
  } else if (is_reported()) {
    say(stderr, "{}\n", numbers());
  }
}

void Progress::draw() const {
  if (frames_) {
    draw_bar("", static_cast<double>(done_) / *frames_, numbers());
  } else {
    say(stderr, "{}{}", kClearLine, numbers());
    std::fflush(stderr);
  }
}

/// Whether a line is due where there is no terminal.
bool Progress::is_reported() const {
  if (!frames_) return done_ % kCountedLines == 0;
  return 10 * done_ / *frames_ != 10 * (done_ - 1) / *frames_;
}

std::string Progress::count() const {
  return frames_ ? fmt::format("{}/{}", done_, *frames_) : fmt::format("{}", done_);
}

std::string Progress::numbers() const {
  if (fed_ == 0)
    return fmt::format("{}  initialising with the first frame, {:.0f} s", count(), seconds_since(start_));
  return fmt::format("{}  {:.2f} FPS  loss {:.4f}  {} Gaussians{}", count(), fed_ / seconds_since(start_),
                     last_.tracking_loss, last_.gaussians, frames_ ? "  ETA " + remaining() : "");
}

std::string Progress::remaining() const {
  if (!pace_.known()) return "-";
  const int seconds = static_cast<int>(pace_.seconds_each() * std::max(0, *frames_ - done_) + 0.5);
  return fmt::format("{}:{:02}", seconds / 60, seconds % 60);
}

CountProgress::CountProgress(std::string what, int total)
    : what_(std::move(what)), total_(std::max(1, total)), terminal_(isatty(STDERR_FILENO) == 1) {}

CountProgress::~CountProgress() {
  if (terminal_) say(stderr, "{}", kClearLine);
}

void CountProgress::reached(int done) {
  if (terminal_) {
    say(stderr, "{}{}/{} {}", kClearLine, done, total_, what_);
    std::fflush(stderr);
  } else if (10 * done / total_ != 10 * (done - 1) / total_) {
    say(stderr, "{}/{} {}\n", done, total_, what_);
  }
}

}  // namespace surefield
