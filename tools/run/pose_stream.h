#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/session/run_observer.h"

namespace surefield {

/// Tells poses while a run goes on, as lines of JSON (docs/live.md, "Poses"): one a frame, as soon as its
/// pose is known, one for a frame that was of no use, and one at the end.
class PoseStream : public RunObserver {
 public:
  /// Takes whole lines; returns whether it may be given more.
  using Sink = std::function<bool(const std::string&)>;

  /// To `place`: "-" for standard output, or a file, which is begun anew. Throws InputError where it cannot
  /// be written to.
  void add_place(const std::string& place);
  void add_sink(Sink sink) { sinks_.push_back(std::move(sink)); }
  bool empty() const { return sinks_.empty(); }

  void begin(const RunStart& start) override;
  void tracked(const Frame& frame, const FrameReport& report) override;
  void fed(const Frame& frame, const Slam& slam, const FrameReport& report) override;
  void skipped(const SkippedFrame& frame) override;
  void finished(const Slam& slam) override;

 private:
  void write(const std::string& line);

  std::vector<Sink> sinks_;
  Pose reference_to_tracked_ = Pose::Identity();
  uint64_t revision_ = 0;
};

}  // namespace surefield
