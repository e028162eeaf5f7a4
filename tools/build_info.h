#pragma once

#include "engine/io/config.h"

namespace surefield {

/// The version of Surefield, for example "0.1.0".
extern const char* const kVersion;

/// The git commit that the program was built from, with "-dirty" behind it where files had been changed;
/// "unknown" where it was built without git.
extern const char* const kGitCommit;

/// The files of configs/ as they were when the program was built.
const BuiltInFiles& built_in_configs();

/// The files of tools/web/, likewise.
const BuiltInFiles& web_page_files();

}  // namespace surefield
