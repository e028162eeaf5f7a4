#include "tools/run/run_input.h"

#include "tools/shared/interrupt.h"
#include "tools/shared/say.h"

namespace surefield {

RunInput::RunInput(const RunOptions& options) {
  if (options.live.empty()) {
    dataset_ = open_run_dataset(options);
    if (options.realtime) replay_ = std::make_unique<TimedReplay>(*dataset_.recording, options.speed);
    return;
  }
  const bool quiet = options.quiet;
  live_ = open_live(options.live, {.stop = interruption(), .waiting = [quiet](const std::string& place) {
                                     if (!quiet)
                                       say(stderr, "surefield: waiting for a sender at {}\n", place);
                                   }});
}

const FrameSource& RunInput::source() const {
  if (replay_) return *replay_;
  if (live_.source) return *live_.source;
  return *dataset_.recording;
}

void RunInput::stream(const FrameSelection& selection) {
  if (replay_)
    prompt_ = std::make_unique<PromptStream>(*replay_, selection);
  else if (!live_.source)
    ahead_ = std::make_unique<FrameStream>(*dataset_.recording, selection);
  else if (live_.source->live())
    prompt_ = std::make_unique<PromptStream>(*live_.source, selection);
  else
    ahead_ = std::make_unique<FrameStream>(*live_.source, selection);
}

}  // namespace surefield
