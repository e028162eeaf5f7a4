#pragma once

#include <filesystem>

#include "engine/logs/message_log.h"
#include "engine/sources/log_contents.h"
#include "engine/sources/open_dataset.h"
#include "tests/fuzz/harness.h"

namespace surefield::fuzz {

/// Opens a log, reads its messages, lists its topics, and opens it as a recording and reads its first frames.
inline void read_log(const std::filesystem::path& file) {
  const auto log = open_log(file);
  for (const MessagePlace& place : log->messages()) {
    expect_answer([&] { log->read(place); });
    expect_answer([&] { log->read_start(place, 64); });
  }
  list_topics(file);
  const Dataset dataset = open_dataset(file);
  for (int i = 0; i < dataset.recording->count() && i < 3; ++i) dataset.recording->load(i);
}

}  // namespace surefield::fuzz
