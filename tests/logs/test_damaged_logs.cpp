// Logs that were cut off, or of which a byte is another: what can be read is read, and nothing worse happens.
#include <set>

#include "tests/logs/written_logs.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr int kCuts = 50;
constexpr int kFlips = 500;

/// What came of opening a log and reading all of it.
struct Reading {
  bool opened = false;
  std::vector<std::string> messages;  ///< that could be read
  std::size_t listed = 0;
  std::size_t warnings = 0;
};

/// Any exception but an InputError, of one line, fails the test.
Reading read_all(const std::filesystem::path& file) {
  Reading reading;
  std::unique_ptr<MessageLog> log;
  input_error([&] { log = open_log(file); });
  if (!log) return reading;
  reading.opened = true;
  reading.listed = log->messages().size();
  reading.warnings = log->warnings().size();
  for (const MessagePlace& place : log->messages()) {
    input_error([&] { reading.messages.push_back(log->read(place)); });
    input_error([&] { log->read_start(place, 30); });
  }
  return reading;
}

}  // namespace

TEST_CASE("a log that was cut off gives whole messages, and says that there were more") {
  const std::vector<WrittenMessage> messages = some_messages();
  std::set<std::string> written;
  for (const WrittenMessage& message : messages) written.insert(message.bytes);
  for (const WrittenLog& kind : all_kinds()) {
    CAPTURE(name_of(kind));
    const TemporaryFolder folder;
    const std::string bytes = bytes_of(kind, messages, folder);
    std::mt19937 random(11);
    std::size_t most = 0;
    for (int i = 0; i < kCuts; ++i) {
      const std::size_t length = random() % bytes.size();
      CAPTURE(length);
      const Reading reading = read_all(folder.write("cut" + kind.extension, bytes.substr(0, length)));
      for (const std::string& message : reading.messages) CHECK(written.contains(message));
      if (reading.opened && reading.listed < messages.size()) CHECK(reading.warnings == 1);
      most = std::max(most, reading.messages.size());
    }
    CHECK(most >= 6);
  }
}

TEST_CASE("a log of which any byte is another is read as far as it goes") {
  const std::vector<WrittenMessage> messages = some_messages();
  for (const WrittenLog& kind : all_kinds()) {
    CAPTURE(name_of(kind));
    const TemporaryFolder folder;
    const std::string bytes = bytes_of(kind, messages, folder);
    std::mt19937 random(17);
    std::size_t read = 0;
    const int flips = kind.extension == ".db3" ? kFlips : kFlips / 5;
    for (int i = 0; i < flips; ++i) {
      std::string flipped = bytes;
      char& byte = flipped[random() % bytes.size()];
      byte = static_cast<char>(byte ^ (1 + random() % 255));
      read += read_all(folder.write("flipped" + kind.extension, flipped)).messages.size();
    }
    CHECK(read > 5 * static_cast<std::size_t>(flips));
  }
}
