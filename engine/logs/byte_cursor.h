#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "engine/types/error.h"

namespace surefield {

static_assert(std::endian::native == std::endian::little, "the numbers of logs are little endian");

/// Reads little endian numbers and byte strings one after the other; nothing is taken from beyond the end.
class ByteCursor {
 public:
  /// `name` is what errors call the bytes; both must outlive the cursor.
  ByteCursor(std::string_view bytes, const std::filesystem::path& name) : bytes_(bytes), name_(name) {}

  std::size_t position() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  bool at_end() const { return left() == 0; }

  /// The next `count` bytes. Throws InputError where there are not so many; so do all below.
  std::string_view bytes(uint64_t count) {
    if (count > left()) throw InputError(name_, "is damaged: a record is longer than what holds it");
    const std::string_view part = bytes_.substr(at_, count);
    at_ += count;
    return part;
  }

  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, bytes(sizeof(T)).data(), sizeof(T));
    return value;
  }

  /// Bytes behind their length as a number of type `Length`.
  template <typename Length = uint32_t>
  std::string_view counted() {
    return bytes(number<Length>());
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  const std::filesystem::path& name_;
};

}  // namespace surefield
