#pragma once

#include "engine/session/run_observer.h"
#include "tools/results/run_configuration.h"

namespace surefield {

/// As run_session(), with a window beside it that shows the run; returns when both have ended. The run has a
/// thread of its own. Throws InputError where no window can be shown.
int run_with_viewer(const RunOptions& options, const RunObservers& observers);

}  // namespace surefield
