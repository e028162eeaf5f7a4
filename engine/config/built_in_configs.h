#pragma once

#include "engine/config/config.h"

namespace surefield {

/// The files of configs/ as they were when the library was built: "base.yaml", "tum.yaml", ...
const BuiltInFiles& built_in_configs();

}  // namespace surefield
