// The messages of an MCAP file.
#include <fmt/format.h>

#include <utility>

#include "engine/logs/chunk_cache.h"
#include "engine/logs/log_index.h"
#include "engine/logs/mcap_format.h"
#include "engine/logs/mcap_index.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

class McapLog : public MessageLog {
 public:
  explicit McapLog(const std::filesystem::path& file) : file_(file) { index_ = index_mcap(file_); }

  std::string read(const MessagePlace& place) const override { return read_start(place, kLargestChunk); }

  std::string read_start(const MessagePlace& place, std::size_t count) const override {
    if (place.inner == MessagePlace::kNoChunk) return read_here(place.at, file_.size(), count);
    const McapChunk chunk = read_chunk_head(file_, place.at);
    if (chunk.packing == Packing::None)
      return read_here(chunk.data_at + place.inner, chunk.data_at + chunk.data_size, count);
    const ChunkCache::Chunk unpacked = cache_.get(place.at, [&] { return unpack_chunk(file_, chunk); });
    if (place.inner > unpacked->size()) throw InputError(file_.path(), "is damaged: a message lies nowhere");
    ByteCursor cursor(std::string_view(*unpacked).substr(place.inner), file_.path());
    const McapRecord record = next_record(cursor);
    return std::string(record.body.substr(data_in(record.op, record.body.size()), count));
  }

 private:
  /// Where the data of a message record begin in its body.
  uint64_t data_in(McapOp op, uint64_t length) const {
    if (op == McapOp::Message && length >= kMcapMessageHead) return kMcapMessageHead;
    throw InputError(file_.path(), "is damaged: there is no message where its index says");
  }

  /// A message that is stored as it is, at `at` of what ends at `end`.
  std::string read_here(uint64_t at, uint64_t end, uint64_t count) const {
    const std::string head = file_.read(at, kMcapRecordHead);
    ByteCursor cursor(head, file_.path());
    const auto op = cursor.number<McapOp>();
    const auto length = cursor.number<uint64_t>();
    const uint64_t body = at + kMcapRecordHead;
    if (body > end || length > end - body)
      throw InputError(file_.path(), "is damaged: a message is longer than what holds it");
    const uint64_t skipped = data_in(op, length);
    return file_.read(body + skipped, std::min(count, length - skipped));
  }

  ByteFile file_;
  mutable ChunkCache cache_;
};

}  // namespace

std::unique_ptr<MessageLog> open_mcap(const std::filesystem::path& file) {
  return std::make_unique<McapLog>(file);
}

}  // namespace surefield
