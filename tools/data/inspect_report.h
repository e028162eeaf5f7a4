#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/eval/verdicts.h"
#include "engine/sources/log_contents.h"

namespace surefield {

/// What was found out about a dataset.
struct Inspection {
  DatasetSurvey survey;
  std::optional<DatasetCheck> check;  ///< nothing where no frame could be read, or the user interrupted
  std::vector<Verdict> verdicts;
  std::vector<ListedTopic> topics;  ///< of a log; empty where the dataset is none
};

/// The topics of a log with what is taken from each, a line each; nothing where there are none.
std::string topics_text(const std::vector<ListedTopic>& topics);

/// What was recognised and read, a line each.
std::string survey_text(const Recording& recording, const DatasetSurvey& survey);

/// The verdicts, those of a kind together: what does not fit last, where the eye falls.
std::string verdicts_text(const std::vector<Verdict>& verdicts);

/// The whole inspection, as docs/evaluation.md describes it.
nlohmann::ordered_json inspection_json(const Recording& recording, const Inspection& inspection);

}  // namespace surefield
