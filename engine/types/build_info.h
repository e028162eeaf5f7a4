#pragma once

namespace surefield {

/// The git commit that the library was built from, with "-dirty" behind it where files had been changed;
/// "unknown" where it was built without git.
extern const char* const kGitCommit;

}  // namespace surefield
