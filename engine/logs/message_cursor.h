#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/logs/byte_cursor.h"

namespace surefield {

/// ROS 1: little endian, one field right behind the other, text without an end mark.
struct Ros1Layout {
  static constexpr bool kSequenceNumber = true;  ///< a header begins with one

  Ros1Layout(std::string_view, const std::filesystem::path&) {}
  static constexpr std::size_t start() { return 0; }
  static constexpr std::size_t padding(std::size_t, std::size_t) { return 0; }
  static constexpr bool swapped() { return false; }
  static constexpr std::size_t end_mark() { return 0; }
};

/// ROS 2, CDR: four bytes that say the byte order, then fields that begin at multiples of their size, counted
/// from behind those; text ends with a zero.
class CdrLayout {
 public:
  static constexpr bool kSequenceNumber = false;

  /// Throws InputError where the first bytes are none of plain CDR, version 1 or 2.
  CdrLayout(std::string_view message, const std::filesystem::path& name) {
    const int kind = message.size() < start()
                         ? -1
                         : 256 * static_cast<uint8_t>(message[0]) + static_cast<uint8_t>(message[1]);
    if (kind != 0 && kind != 1 && kind != 6 && kind != 7)
      throw InputError(name, "is damaged: a message does not begin as CDR");
    swapped_ = kind % 2 == 0;
    if (kind > 1) largest_ = 4;
  }
  static constexpr std::size_t start() { return 4; }
  std::size_t padding(std::size_t at, std::size_t size) const {
    const std::size_t step = std::min(size, largest_), beyond = (at - start()) % step;
    return beyond == 0 ? 0 : step - beyond;
  }
  bool swapped() const { return swapped_; }
  static constexpr std::size_t end_mark() { return 1; }

 private:
  bool swapped_ = false;
  std::size_t largest_ = 8;
};

/// Reads the fields of a message one after the other. Throws InputError where it ends too early.
template <typename Layout>
class MessageCursor {
 public:
  /// `message` and `name`, which is what errors call it, must outlive the cursor.
  MessageCursor(std::string_view message, const std::filesystem::path& name)
      : layout_(message, name), cursor_(message, name) {
    cursor_.bytes(layout_.start());
  }

  template <typename T>
  T number() {
    cursor_.bytes(layout_.padding(cursor_.position(), sizeof(T)));
    std::string_view bytes = cursor_.bytes(sizeof(T));
    std::array<char, sizeof(T)> ordered{};
    std::copy(bytes.begin(), bytes.end(), ordered.begin());
    if (layout_.swapped()) std::reverse(ordered.begin(), ordered.end());
    T value;
    std::memcpy(&value, ordered.data(), sizeof(T));
    return value;
  }

  std::string text() {
    std::string_view bytes = data();
    if (layout_.end_mark() > 0 && !bytes.empty()) bytes.remove_suffix(layout_.end_mark());
    return std::string(bytes);
  }

  /// A sequence of bytes.
  std::string_view data() { return cursor_.bytes(number<uint32_t>()); }

  template <std::size_t N>
  std::array<double, N> doubles() {
    std::array<double, N> values;
    for (double& value : values) value = number<double>();
    return values;
  }

  /// A sequence of numbers.
  std::vector<double> double_list() {
    const auto count = number<uint32_t>();
    if (count > cursor_.left() / sizeof(double)) cursor_.bytes(uint64_t{count} * sizeof(double));
    std::vector<double> values(count);
    for (double& value : values) value = number<double>();
    return values;
  }

  std::size_t left() const { return cursor_.left(); }

 private:
  Layout layout_;
  ByteCursor cursor_;
};

}  // namespace surefield
