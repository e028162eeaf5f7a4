#pragma once

#include <cstdint>
#include <string_view>

#include "engine/logs/byte_cursor.h"
#include "engine/logs/byte_file.h"
#include "engine/logs/unpack.h"

namespace surefield {

/// What MCAP files begin and end with.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// The records that are looked at; the numbers are the format's.
enum class McapOp : uint8_t {
  Footer = 0x02,
  Schema = 0x03,
  Channel = 0x04,
  Message = 0x05,
  Chunk = 0x06,
  MessageIndex = 0x07,
  ChunkIndex = 0x08,
  Statistics = 0x0b,
  DataEnd = 0x0f
};

/// A record begins with its kind and the length of the rest.
inline constexpr uint64_t kMcapRecordHead = 1 + sizeof(uint64_t);

/// A message begins with channel, sequence number, log stamp and publish stamp.
inline constexpr uint64_t kMcapMessageHead = 2 + 4 + 8 + 8;

/// A record and the rest of its bytes.
struct McapRecord {
  McapOp op{};
  std::string_view body;
};

/// The next record of a cursor. Throws InputError where it is not complete.
McapRecord next_record(ByteCursor& cursor);

/// Where a chunk's messages are and how they are packed.
struct McapChunk {
  uint64_t unpacked_size = 0;
  uint32_t checksum = 0;  ///< CRC-32 of what is unpacked; 0: none
  Packing packing = Packing::None;
  uint64_t data_at = 0;  ///< bytes from the start of the file
  uint64_t data_size = 0;
};

/// Reads the head of the chunk record at `at`. Throws InputError where there is none, or it is not complete,
/// or packed in a way that is not known.
McapChunk read_chunk_head(const ByteFile& file, uint64_t at);

/// The unpacked chunk. Throws InputError where it is damaged.
std::string unpack_chunk(const ByteFile& file, const McapChunk& chunk);

}  // namespace surefield
