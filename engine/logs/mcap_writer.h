#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace surefield {

/// Writes an MCAP file of ROS 2 messages: chunks packed by zstd, an index behind each and one of all at the
/// end. The file appears under its name when close() has written it whole; until then it has ".part" behind
/// it. Not thread-safe.
class McapWriter {
 public:
  /// Throws InputError where the file cannot be written.
  explicit McapWriter(std::filesystem::path file);
  /// Removes what was not closed.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Adds a topic; `type` as in "sensor_msgs/msg/Image", `definition` the text of its message and of all that
  /// it is made of (ros2msg). Returns what write() calls it.
  uint16_t add_topic(const std::string& name, const std::string& type, const std::string& definition);
  /// Adds a message, CDR. `stamp`: nanoseconds. Throws InputError where the disk is full.
  void write(uint16_t topic, int64_t stamp, std::string_view message);
  /// Writes the last chunk and the index. Throws InputError.
  void close();

 private:
  struct Topic {
    std::string definitions;  ///< its records: schema and channel
    uint64_t messages = 0;
  };
  void put(const std::string& bytes);
  void end_chunk();
  std::string summary() const;

  std::filesystem::path file_, part_;
  std::ofstream stream_;
  uint64_t written_ = 0;
  bool closed_ = false;
  std::vector<Topic> topics_;
  std::string chunk_;
  std::map<uint16_t, std::string> chunk_index_;  ///< stamp and offset of each message, by topic
  int64_t chunk_first_ = 0, chunk_last_ = 0;     ///< stamps
  std::string chunk_places_;                     ///< records of the index at the end
  uint32_t chunks_ = 0;
  int64_t first_ = 0, last_ = 0;
};

}  // namespace surefield
