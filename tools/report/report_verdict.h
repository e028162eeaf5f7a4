#pragma once

#include <string>
#include <vector>

#include "tools/report/report_data.h"

namespace surefield {

enum class VerdictLevel { Good, Fair, Bad };

/// How good a run was, all told.
struct Verdict {
  VerdictLevel level = VerdictLevel::Good;
  std::vector<std::string> reasons;  ///< why it is not better; each a part of a sentence
};

/// Judges a run by its end, its frames, its trajectory, its images, depth and floaters: the worst of these
/// decides. What a run has no figure of is not judged.
Verdict judge(const ReportRun& run);

/// "good", "fair" or "bad", which name the colours too.
const char* name_of(VerdictLevel level);

/// The limits that judge() has, for people.
std::string verdict_limits();

}  // namespace surefield
