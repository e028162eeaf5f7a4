#pragma once

#include "engine/config/config.h"

namespace surefield {

/// The files of tools/web/ as they were when the program was built.
const BuiltInFiles& web_page_files();

}  // namespace surefield
