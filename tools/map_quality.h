#pragma once

#include "tools/run_record.h"

namespace surefield {

/// Renders the final map at the final poses of evenly spaced frames (all of them where there are at most 60)
/// and stores the mean PSNR against the frames in `record`. Stops without a result when the user interrupts.
void measure_map_quality(RunRecord& record, const Slam& slam, const Dataset& dataset);

}  // namespace surefield
