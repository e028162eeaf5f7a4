#include "engine/logs/mcap_format.h"

#include <fmt/format.h>
#include <zlib.h>

#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr uint64_t kLongestChunkHead = 256;

}  // namespace

McapRecord next_record(ByteCursor& cursor) {
  const auto op = cursor.number<McapOp>();
  return {op, cursor.counted<uint64_t>()};
}

McapChunk read_chunk_head(const ByteFile& file, uint64_t at) {
  const std::string head = file.read_up_to(at, kLongestChunkHead);
  ByteCursor cursor(head, file.path());
  if (cursor.number<McapOp>() != McapOp::Chunk)
    throw InputError(file.path(), fmt::format("is damaged: there is no chunk at byte {}", at));
  const auto length = cursor.number<uint64_t>();
  cursor.number<uint64_t>();  // the first and the last stamp
  cursor.number<uint64_t>();
  McapChunk chunk;
  chunk.unpacked_size = cursor.number<uint64_t>();
  chunk.checksum = cursor.number<uint32_t>();
  const std::string_view packing = cursor.counted();
  chunk.data_size = cursor.number<uint64_t>();
  chunk.data_at = at + cursor.position();
  const auto known = packing_of(packing);
  if (!known || *known == Packing::Bz2) {
    throw InputError(file.path(),
                     "packs its chunks in a way that is not known: " + printable(std::string(packing)));
  }
  chunk.packing = *known;
  const uint64_t head_size = cursor.position() - kMcapRecordHead;
  if (length < head_size || chunk.data_size > length - head_size)
    throw InputError(file.path(),
                     fmt::format("is damaged: the chunk at byte {} is longer than its record", at));
  if (chunk.data_at > file.size() || chunk.data_size > file.size() - chunk.data_at)
    throw InputError(file.path(), "ends too early; it may have been cut off");
  return chunk;
}

std::string unpack_chunk(const ByteFile& file, const McapChunk& chunk) {
  if (chunk.data_size > kLargestChunk) throw InputError(file.path(), "is damaged: a chunk is too large");
  std::string bytes = file.read(chunk.data_at, chunk.data_size);
  if (chunk.packing != Packing::None || chunk.unpacked_size != chunk.data_size)
    bytes = unpack(bytes, chunk.packing, chunk.unpacked_size, file.path());
  const auto checksum =
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  if (chunk.checksum != 0 && chunk.checksum != checksum)
    throw InputError(file.path(), "is damaged: the checksum of a chunk is wrong");
  return bytes;
}

}  // namespace surefield
