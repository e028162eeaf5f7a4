#include "tools/run/cost_note.h"

#include "engine/slam/slam.h"
#include "engine/types/frame.h"
#include "tools/shared/say.h"

namespace surefield {

namespace {

constexpr int kJudgedFrames = 8;      // by which the others are judged; a keyframe or two is among them
constexpr double kLongRun = 120;      // seconds, from which the user is told
constexpr double kOfHalfTheSize = 3;  // times less that images of half the size take (docs/results.md)

}  // namespace

void CostNote::fed(const Frame& frame, const Slam& slam, const FrameReport&) {
  if (!wanted_) return;
  if (++fed_ == 1) second_ = Clock::now();
  if (fed_ <= kJudgedFrames) return;
  wanted_ = false;
  const double each = std::chrono::duration<double>(Clock::now() - second_).count() / kJudgedFrames;
  const double left = frames_ ? each * (*frames_ - fed_) : 0;
  if (left < kLongRun || !slam.engine_report().is_cpu) return;
  say(stderr,
      "surefield: note: on this CPU a frame of {} x {} takes about {:.1f} s, the other {} frames {:.0f} min; "
      "with "
      "--scale 0.5 they would take about {:.0f}\n",
      frame.colour.cols, frame.colour.rows, each, *frames_ - fed_, left / 60, left / 60 / kOfHalfTheSize);
}

}  // namespace surefield
