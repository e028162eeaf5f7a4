#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace surefield {

/// Serialises a ROS 2 message as CDR, little endian, one field after the other.
class CdrWriter {
 public:
  template <typename T>
  CdrWriter& number(T value) {
    bytes_.resize(kHead + (bytes_.size() - kHead + sizeof(T) - 1) / sizeof(T) * sizeof(T));
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  CdrWriter& text(std::string_view text) {
    number(static_cast<uint32_t>(text.size() + 1));
    bytes_ += text;
    bytes_ += '\0';
    return *this;
  }
  CdrWriter& data(std::string_view data) {
    number(static_cast<uint32_t>(data.size()));
    bytes_ += data;
    return *this;
  }
  template <typename Numbers>
  CdrWriter& doubles(const Numbers& numbers) {
    for (const double value : numbers) number(value);
    return *this;
  }
  /// std_msgs/Header. `stamp`: nanoseconds.
  CdrWriter& header(int64_t stamp, std::string_view frame) {
    return number(static_cast<int32_t>(stamp / kSecond))
        .number(static_cast<uint32_t>(stamp % kSecond))
        .text(frame);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kHead = 4;  // how the message is serialised; fields are aligned behind it
  static constexpr int64_t kSecond = 1000000000;
  std::string bytes_{"\0\1\0\0", kHead};
};

}  // namespace surefield
