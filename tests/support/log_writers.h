#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace surefield::test {

/// How messages are serialised by a MessageWriter.
enum class Wire { Ros1, Cdr, CdrBigEndian };

/// Writes the fields of a message one after the other.
class MessageWriter {
 public:
  explicit MessageWriter(Wire wire) : wire_(wire) {
    if (wire != Wire::Ros1) bytes_ = std::string(wire == Wire::Cdr ? "\0\1\0\0" : "\0\0\0\0", 4);
  }

  template <typename T>
  MessageWriter& number(T value) {
    while (wire_ != Wire::Ros1 && (bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
    std::string written(reinterpret_cast<const char*>(&value), sizeof(T));
    if (wire_ == Wire::CdrBigEndian) std::reverse(written.begin(), written.end());
    bytes_ += written;
    return *this;
  }
  MessageWriter& text(const std::string& text) {
    number(static_cast<uint32_t>(text.size() + (wire_ == Wire::Ros1 ? 0 : 1)));
    bytes_ += text;
    if (wire_ != Wire::Ros1) bytes_ += '\0';
    return *this;
  }
  MessageWriter& data(std::string_view data) {
    number(static_cast<uint32_t>(data.size()));
    bytes_ += data;
    return *this;
  }
  MessageWriter& doubles(const std::vector<double>& values) {
    for (const double value : values) number(value);
    return *this;
  }
  /// std_msgs/Header.
  MessageWriter& header(int64_t stamp, const std::string& frame) {
    if (wire_ == Wire::Ros1) number(uint32_t{0});
    number(static_cast<uint32_t>(stamp / 1000000000)).number(static_cast<uint32_t>(stamp % 1000000000));
    return text(frame);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  Wire wire_;
  std::string bytes_;
};

/// A message of a log that is written.
struct WrittenMessage {
  std::string topic;
  std::string type;   ///< "sensor_msgs/Image"
  int64_t stamp = 0;  ///< nanoseconds
  std::string bytes;
};

/// How a log is written.
struct LogStyle {
  std::string packing;      ///< of MCAP "", "lz4" or "zstd"; of bags "none", "lz4" or "bz2"
  bool chunked = true;      ///< MCAP alone
  bool index = true;        ///< whether there is an index at the end; without it the file just stops
  bool chunk_index = true;  ///< MCAP alone: whether an index follows each chunk
  std::size_t per_chunk = 3;
  bool ros1 = false;  ///< MCAP alone: messages of ROS 1
};

/// The bytes of an MCAP file with these messages.
std::string mcap_of(const std::vector<WrittenMessage>& messages, const LogStyle& style = {});

/// The bytes of a ROS 1 bag with these messages.
std::string bag_of(const std::vector<WrittenMessage>& messages, const LogStyle& style = {.packing = "none"});

/// Writes a database as ROS 2 does.
void write_db3(const std::filesystem::path& file, const std::vector<WrittenMessage>& messages);

/// Packs by the libraries themselves.
std::string packed(const std::string& bytes, const std::string& packing);

}  // namespace surefield::test
