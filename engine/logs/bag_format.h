#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "engine/logs/byte_cursor.h"
#include "engine/logs/byte_file.h"
#include "engine/logs/unpack.h"

namespace surefield {

/// What ROS 1 bags of version 2.0 begin with.
inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

/// The kinds of records; the numbers are the format's.
enum class BagOp : uint8_t { Message = 2, File = 3, Index = 4, Chunk = 5, ChunkInfo = 6, Connection = 7 };

/// The head of a record: named fields.
class BagFields {
 public:
  /// `bytes` are fields "length name=value"; `name` is what errors call them. Both must outlive this. Throws
  /// InputError where they are damaged.
  BagFields(std::string_view bytes, const std::filesystem::path& name);

  /// The kind of the record.
  BagOp op() const { return number<BagOp>("op"); }
  bool has(std::string_view field) const { return fields_.contains(field); }
  /// A field as text; empty where there is none.
  std::string_view text(std::string_view field) const;
  /// A field that holds a number of that type. Throws InputError where there is none.
  template <typename T>
  T number(std::string_view field) const {
    ByteCursor cursor(text(field), name_);
    return cursor.number<T>();
  }
  /// A field that holds seconds and nanoseconds, in nanoseconds.
  int64_t stamp(std::string_view field) const;

 private:
  std::map<std::string_view, std::string_view> fields_;
  const std::filesystem::path& name_;
};

/// Seconds and nanoseconds as nanoseconds.
int64_t bag_stamp(uint64_t seconds_and_nanoseconds);

/// Where a record of a file lies.
struct BagRecord {
  std::string head;      ///< its fields
  uint64_t data_at = 0;  ///< bytes from the start of the file
  uint64_t data_size = 0;

  uint64_t end() const { return data_at + data_size; }
};

/// The record at `at`. Throws InputError where it is not complete.
BagRecord read_bag_record(const ByteFile& file, uint64_t at);

/// A record in memory.
struct BagRecordView {
  std::string_view head;
  std::string_view data;
};

/// The next record of a cursor. Throws InputError where it is not complete.
BagRecordView next_bag_record(ByteCursor& cursor);

/// The unpacked chunk of a chunk record. Throws InputError where it is none, or damaged.
std::string unpack_bag_chunk(const ByteFile& file, const BagRecord& record);

}  // namespace surefield
