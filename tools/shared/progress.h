#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "engine/session/run_observer.h"
#include "tools/shared/recent_pace.h"

namespace surefield {

/// Seconds that have passed since `start`.
double seconds_since(std::chrono::steady_clock::time_point start);

/// Shows on stderr how far a run is: a bar where that is a terminal, drawn anew every second from the first
/// one, else a line for every tenth of the frames.
class Progress : public RunObserver {
 public:
  /// `frames` is how many there will be, the skipped ones included; where nobody knows, the line only counts.
  Progress(std::optional<int> frames, bool quiet);
  ~Progress() override;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void fed(const Frame& frame, const Slam& slam, const FrameReport& report) override;
  void skipped(const SkippedFrame& frame) override;

 private:
  void tick();
  void advance();
  void draw() const;
  bool is_reported() const;
  std::string count() const;
  std::string numbers() const;
  std::string remaining() const;

  std::optional<int> frames_;
  bool quiet_;
  bool terminal_;
  int done_ = 0;
  int fed_ = 0;
  int skipped_ = 0;
  FrameReport last_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_end_;  ///< of the last frame that was done
  RecentPace pace_;  ///< of all frames but the first, which takes far longer than the others

  std::mutex mutex_;  ///< guards what is above and the line on the terminal
  std::condition_variable ending_;
  bool ended_ = false;
  std::thread ticker_;
};

/// Shows on stderr how many of a number of things are done: a line that counts where that is a terminal, else
/// a line for every tenth of them.
class CountProgress {
 public:
  /// `what` is done `total` times.
  CountProgress(std::string what, int total);
  ~CountProgress();
  CountProgress(const CountProgress&) = delete;
  CountProgress& operator=(const CountProgress&) = delete;

  void reached(int done);

 private:
  std::string what_;
  int total_;
  bool terminal_;
};

}  // namespace surefield
