#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace surefield {

/// How the fields of a message follow each other.
enum class Serialisation { Cdr, Ros1, Other };

/// One topic of a log.
struct LogTopic {
  std::string name;
  std::string type;  ///< package and name, "sensor_msgs/Image"; ROS 2's "/msg/" between them is left out
  Serialisation serialisation = Serialisation::Other;
  std::string encoding;   ///< as the log calls it: "cdr", "ros1", "json", ...
  uint64_t messages = 0;  ///< that can be found in the log
};

/// Where one message of a log lies.
struct MessagePlace {
  static constexpr uint32_t kNoChunk = UINT32_MAX;

  int64_t stamp = 0;          ///< nanoseconds, when it was logged
  uint64_t at = 0;            ///< its chunk, or itself: bytes from the start of the file; a database's row
  uint32_t inner = kNoChunk;  ///< bytes from the start of the unpacked chunk
  uint16_t topic = 0;         ///< of MessageLog::topics()
  uint16_t part = 0;          ///< which file of a log that was split
};

/// What is known of a log without its messages: some 24 bytes for each of them.
struct LogIndex {
  std::vector<LogTopic> topics;
  std::vector<MessagePlace> messages;  ///< in the order of their stamps; of equal ones in that of the file
  std::vector<std::string> warnings;   ///< what could not be read, a line for each file
};

/// A file of messages by topics, as robots record them, or several files of one recording. Opening it finds
/// where each message lies, by the file's own index where it has one, else in one pass that holds one chunk
/// at a time. All of it may be used by any thread.
class MessageLog {
 public:
  virtual ~MessageLog() = default;

  const std::vector<LogTopic>& topics() const { return index_.topics; }
  const std::vector<MessagePlace>& messages() const { return index_.messages; }
  const std::vector<std::string>& warnings() const { return index_.warnings; }

  /// The bytes of a message of messages(). Throws InputError where they are damaged.
  virtual std::string read(const MessagePlace& place) const = 0;

  /// At least its first `count` bytes, where it has so many: where the log is not packed, the others are left
  /// unread.
  virtual std::string read_start(const MessagePlace& place, std::size_t count) const = 0;

 protected:
  LogIndex index_;
};

/// The files of the log at `path`: itself, where it is named as a log (.mcap, .db3, .bag), or those that a
/// folder holds, in their order. Empty where it is no log.
std::vector<std::filesystem::path> log_files(const std::filesystem::path& path);

/// Opens a log: ROS 2's .mcap and .db3, ROS 1's .bag 2.0; a file, or a folder that holds one. Several files
/// of a folder are one recording where metadata.yaml says so or where their names differ in the number at
/// their end alone. What is cut off or damaged is left out with a warning. Throws InputError where nothing
/// can be read at all.
std::unique_ptr<MessageLog> open_log(const std::filesystem::path& path);

}  // namespace surefield
