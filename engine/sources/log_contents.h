#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/logs/message_log.h"
#include "engine/sources/open_dataset.h"

namespace surefield {

/// A topic of a log, and what a recording takes from it.
struct ListedTopic {
  LogTopic topic;
  std::string use;  ///< "colour", "depth", "camera of colour", "camera of depth", "poses"; empty: nothing
};

/// The topics of the log at `path`, in the order of their names, each with what open_dataset() with these
/// options takes from it. Empty where `path` is no log. Throws InputError where nothing in it can be read.
std::vector<ListedTopic> list_topics(const std::filesystem::path& path, const DatasetOptions& options = {});

}  // namespace surefield
