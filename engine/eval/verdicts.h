#pragma once

#include <string>
#include <vector>

#include "engine/eval/dataset_check.h"
#include "engine/eval/dataset_survey.h"
#include "engine/sources/plausibility.h"

namespace surefield {

enum class Outcome { Fits, DoesNotFit, NotChecked };

/// What is said about one thing of a dataset.
struct Verdict {
  std::string subject;  ///< "files", "focal_length", ...
  Outcome outcome = Outcome::NotChecked;
  std::string text;  ///< what fits; what does not, by how much and what to change; or why it was not checked
};

/// "fits", "does_not_fit" or "not_checked".
const char* name(Outcome outcome);

/// What reading the dataset says: files, sizes, frames, stamps, intrinsics, depth, poses, in this order.
/// `truth` is the true trajectory, null where there is none; the limit of `reach` is that of the survey.
std::vector<Verdict> survey_verdicts(const Recording& recording, const Trajectory* truth,
                                     const DatasetSurvey& survey, const DepthReach& reach);

/// What comparing frames says: depth_scale, focal_length, focal_ratio, registration, depth_delay, pose_delay.
std::vector<Verdict> check_verdicts(const DatasetCheck& check, const Recording& recording);

/// The texts of what does not fit.
std::vector<std::string> findings_of(const std::vector<Verdict>& verdicts);

}  // namespace surefield
