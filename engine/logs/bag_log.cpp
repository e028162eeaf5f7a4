// The messages of a ROS 1 bag.
#include <algorithm>

#include "engine/logs/bag_format.h"
#include "engine/logs/bag_index.h"
#include "engine/logs/chunk_cache.h"
#include "engine/logs/log_index.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

class BagLog : public MessageLog {
 public:
  explicit BagLog(const std::filesystem::path& file) : file_(file) { index_ = index_bag(file_); }

  std::string read(const MessagePlace& place) const override { return read_start(place, kLargestChunk); }

  std::string read_start(const MessagePlace& place, std::size_t count) const override {
    const BagRecord record = read_bag_record(file_, place.at);
    if (place.inner == MessagePlace::kNoChunk) return read_here(record, count);
    if (BagFields(record.head, file_.path()).text("compression") == "none") {
      const BagRecord message = read_bag_record(file_, record.data_at + place.inner);
      if (message.end() > record.end())
        throw InputError(file_.path(), "is damaged: a message is longer than what holds it");
      return read_here(message, count);
    }
    const ChunkCache::Chunk chunk = cache_.get(place.at, [&] { return unpack_bag_chunk(file_, record); });
    if (place.inner > chunk->size()) throw InputError(file_.path(), "is damaged: a message lies nowhere");
    ByteCursor cursor(std::string_view(*chunk).substr(place.inner), file_.path());
    const BagRecordView message = next_bag_record(cursor);
    require_message(message.head);
    return std::string(message.data.substr(0, count));
  }

 private:
  void require_message(std::string_view head) const {
    if (BagFields(head, file_.path()).op() != BagOp::Message)
      throw InputError(file_.path(), "is damaged: there is no message where its index says");
  }

  std::string read_here(const BagRecord& message, uint64_t count) const {
    require_message(message.head);
    return file_.read(message.data_at, std::min(count, message.data_size));
  }

  ByteFile file_;
  mutable ChunkCache cache_;
};

}  // namespace

std::unique_ptr<MessageLog> open_bag(const std::filesystem::path& file) {
  return std::make_unique<BagLog>(file);
}

}  // namespace surefield
