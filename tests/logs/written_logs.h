#pragma once

#include <random>
#include <string>
#include <vector>

#include "engine/logs/message_log.h"
#include "tests/support/input_files.h"
#include "tests/support/log_writers.h"

namespace surefield::test {

/// Ten messages of two topics, of some hundred bytes each.
inline std::vector<WrittenMessage> some_messages() {
  std::vector<WrittenMessage> messages;
  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i) {
    // Bytes that begin as CDR does.
    std::string bytes("\0\1\0\0", 4);
    for (int n = 0; n < 100 + 40 * i; ++n) bytes += static_cast<char>(random() % 7);
    messages.push_back({i % 3 == 0 ? "/camera/info" : "/camera/image",
                        i % 3 == 0 ? "sensor_msgs/CameraInfo" : "sensor_msgs/Image",
                        1700000000000000000 + i * 1000, bytes});
  }
  return messages;
}

/// A way of writing a log, and how files of it end.
struct WrittenLog {
  std::string extension;
  LogStyle style;
};

/// Every kind of log and of packing, with and without index.
inline std::vector<WrittenLog> all_kinds() {
  std::vector<WrittenLog> kinds;
  for (const char* packing : {"", "lz4", "zstd"})
    for (const bool index : {true, false}) kinds.push_back({".mcap", {.packing = packing, .index = index}});
  kinds.push_back({".mcap", {.packing = "zstd", .chunk_index = false}});
  kinds.push_back({".mcap", {.chunked = false}});
  kinds.push_back({".mcap", {.chunked = false, .index = false}});
  for (const char* packing : {"none", "lz4", "bz2"})
    for (const bool index : {true, false}) kinds.push_back({".bag", {.packing = packing, .index = index}});
  kinds.push_back({".db3", {}});
  return kinds;
}

/// The name of a kind, for messages of tests.
inline std::string name_of(const WrittenLog& kind) {
  return kind.extension + " " + kind.style.packing + (kind.style.index ? "" : ", no index") +
         (kind.style.chunked ? "" : ", no chunks");
}

/// The bytes of a log.
inline std::string bytes_of(const WrittenLog& kind, const std::vector<WrittenMessage>& messages,
                            const TemporaryFolder& folder) {
  if (kind.extension == ".mcap") return mcap_of(messages, kind.style);
  if (kind.extension == ".bag") return bag_of(messages, kind.style);
  write_db3(folder / "written.db3", messages);
  std::ifstream stream(folder / "written.db3", std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace surefield::test
