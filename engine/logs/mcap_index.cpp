// MCAP (mcap.dev/spec): records of a byte for the kind, a 64-bit length, and that many bytes. Messages lie in
// chunks or beside them; a summary at the end says where the chunks are, and an index behind each chunk where
// its messages are.
#include "engine/logs/mcap_index.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "engine/logs/log_index.h"
#include "engine/logs/mcap_format.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr uint64_t kFooterBody = 8 + 8 + 4;
constexpr uint64_t kLargestSummary = uint64_t{256} << 20;
constexpr uint64_t kLargestDefinition = uint64_t{16} << 20;  // of a schema or a channel

struct ChunkPlace {
  uint64_t at = 0, length = 0;
  uint64_t index_length = 0;  ///< of the message indexes right behind it
};

class McapIndexer {
 public:
  explicit McapIndexer(const ByteFile& file) : file_(file), builder_(file.path()) {}

  LogIndex index() {
    if (file_.read_up_to(0, kMcapMagic.size()) != kMcapMagic)
      throw InputError(file_.path(), "is no MCAP file: it does not begin as one");
    if (!by_summary()) {
      builder_ = IndexBuilder(file_.path());
      schemas_.clear();
      channels_.clear();
      by_reading();
    }
    return builder_.finish();
  }

 private:
  // By the summary.
  bool by_summary();
  std::string read_summary() const;
  void index_chunk(const ChunkPlace& chunk);
  void read_message_index(ByteCursor cursor, uint64_t chunk);

  // From front to back.
  void by_reading();
  uint64_t read_records();
  void read_record(McapOp op, uint64_t at, uint64_t length);

  void define(McapOp op, std::string_view body);
  void add_message(std::string_view head, uint64_t at, uint32_t inner);
  void scan_chunk(std::string_view chunk, uint64_t at);

  const ByteFile& file_;
  IndexBuilder builder_;
  std::map<uint16_t, std::string> schemas_;
  std::map<uint16_t, uint16_t> channels_;  ///< the topic of each
  bool ended_ = false;                     ///< whether the records end as they should
};

/// Takes note of a schema or a channel.
void McapIndexer::define(McapOp op, std::string_view body) {
  ByteCursor cursor(body, file_.path());
  const auto id = cursor.number<uint16_t>();
  if (op == McapOp::Schema) {
    schemas_[id] = cursor.counted();
    return;
  }
  const auto schema = cursor.number<uint16_t>();
  const std::string_view topic = cursor.counted(), encoding = cursor.counted();
  channels_[id] = builder_.topic(topic, schemas_[schema], encoding);
}

void McapIndexer::add_message(std::string_view head, uint64_t at, uint32_t inner) {
  ByteCursor cursor(head, file_.path());
  const auto channel = channels_.find(cursor.number<uint16_t>());
  cursor.number<uint32_t>();
  const auto stamp = cursor.number<int64_t>();
  if (channel == channels_.end()) throw InputError(file_.path(), "is damaged: a message has no channel");
  builder_.add({stamp, at, inner, channel->second});
}

std::string McapIndexer::read_summary() const {
  const uint64_t tail = kMcapRecordHead + kFooterBody + kMcapMagic.size();
  if (file_.size() < kMcapMagic.size() + tail) return {};
  const std::string end = file_.read(file_.size() - tail, tail);
  ByteCursor cursor(end, file_.path());
  if (!end.ends_with(kMcapMagic) || cursor.number<McapOp>() != McapOp::Footer ||
      cursor.number<uint64_t>() != kFooterBody)
    return {};
  const auto start = cursor.number<uint64_t>();
  const uint64_t footer = file_.size() - tail;
  if (start < kMcapMagic.size() || start >= footer || footer - start > kLargestSummary) return {};
  return file_.read(start, footer - start);
}

/// False where the summary is missing, damaged, or does not speak of all messages.
bool McapIndexer::by_summary() {
  try {
    const std::string summary = read_summary();
    if (summary.empty()) return false;
    std::vector<ChunkPlace> chunks;
    std::optional<uint64_t> promised;
    ByteCursor cursor(summary, file_.path());
    while (!cursor.at_end()) {
      const McapRecord record = next_record(cursor);
      ByteCursor body(record.body, file_.path());
      if (record.op == McapOp::Schema || record.op == McapOp::Channel) {
        define(record.op, record.body);
      } else if (record.op == McapOp::Statistics) {
        promised = body.number<uint64_t>();
      } else if (record.op == McapOp::ChunkIndex) {
        body.bytes(2 * sizeof(uint64_t));  // stamps
        ChunkPlace chunk;
        chunk.at = body.number<uint64_t>();
        chunk.length = body.number<uint64_t>();
        body.counted();  // where the index of each channel begins
        chunk.index_length = body.number<uint64_t>();
        chunks.push_back(chunk);
      }
    }
    std::stable_sort(chunks.begin(), chunks.end(),
                     [](const ChunkPlace& a, const ChunkPlace& b) { return a.at < b.at; });
    uint64_t end = 0;
    for (const ChunkPlace& chunk : chunks) {
      if (chunk.at < end) return false;  // two chunks in one place
      index_chunk(chunk);
      end = chunk.at + chunk.length + chunk.index_length;
    }
    return promised ? *promised == builder_.messages() : !chunks.empty();
  } catch (const InputError&) {
    return false;
  }
}

void McapIndexer::index_chunk(const ChunkPlace& chunk) {
  if (chunk.at > file_.size() || chunk.length > file_.size() - chunk.at)
    throw InputError(file_.path(), "is damaged: a chunk lies behind its end");
  if (chunk.index_length == 0) {
    scan_chunk(unpack_chunk(file_, read_chunk_head(file_, chunk.at)), chunk.at);
    return;
  }
  const std::string indexes = file_.read(chunk.at + chunk.length, chunk.index_length);
  // The messages of all channels, in the order in which they lie in the chunk.
  const std::size_t before = builder_.messages();
  ByteCursor cursor(indexes, file_.path());
  while (!cursor.at_end()) {
    const McapRecord record = next_record(cursor);
    if (record.op != McapOp::MessageIndex)
      throw InputError(file_.path(), "is damaged: an index of messages is none");
    read_message_index(ByteCursor(record.body, file_.path()), chunk.at);
  }
  builder_.sort_from(before);
}

void McapIndexer::read_message_index(ByteCursor cursor, uint64_t chunk) {
  const auto channel = channels_.find(cursor.number<uint16_t>());
  ByteCursor entries(cursor.counted(), file_.path());
  while (!entries.at_end()) {
    const auto stamp = entries.number<int64_t>();
    const auto offset = entries.number<uint64_t>();
    if (channel == channels_.end() || offset >= kLargestChunk)
      throw InputError(file_.path(), "is damaged: an index of messages is wrong");
    builder_.add({stamp, chunk, static_cast<uint32_t>(offset), channel->second});
  }
}

void McapIndexer::by_reading() {
  const uint64_t end = read_records();
  if (builder_.messages() == 0 && channels_.empty() && end < file_.size())
    throw InputError(file_.path(), "nothing in it can be read; it may be damaged, or cut off at once");
  builder_.warn_of_losses(end, file_.size(),
                          ended_ ? "" : "it has no end, as where the recorder was stopped");
}

/// Goes from record to record; returns where it could not go on, or the size of the file.
uint64_t McapIndexer::read_records() {
  uint64_t at = kMcapMagic.size();
  while (at < file_.size()) {
    const std::string head = file_.read_up_to(at, kMcapRecordHead);
    if (head.size() < kMcapRecordHead) return at;
    ByteCursor cursor(head, file_.path());
    const auto op = cursor.number<McapOp>();
    const auto length = cursor.number<uint64_t>();
    const uint64_t body = at + kMcapRecordHead;
    if (length > file_.size() - body || static_cast<uint8_t>(op) == 0) return at;
    if (op == McapOp::DataEnd || op == McapOp::Footer) {
      ended_ = true;
      return file_.size();
    }
    try {
      read_record(op, at, length);
    } catch (const InputError&) {
      return at;
    }
    at = body + length;
  }
  return at;
}

void McapIndexer::read_record(McapOp op, uint64_t at, uint64_t length) {
  const uint64_t body = at + kMcapRecordHead;
  if (op == McapOp::Chunk) {
    builder_.add_chunk([&] { scan_chunk(unpack_chunk(file_, read_chunk_head(file_, at)), at); });
  } else if (op == McapOp::Message) {
    if (length < kMcapMessageHead) throw InputError(file_.path(), "is damaged: a message is too short");
    add_message(file_.read(body, kMcapMessageHead), at, MessagePlace::kNoChunk);
  } else if (op == McapOp::Schema || op == McapOp::Channel) {
    if (length > kLargestDefinition) throw InputError(file_.path(), "is damaged: a definition is too large");
    define(op, file_.read(body, length));
  }
}

void McapIndexer::scan_chunk(std::string_view chunk, uint64_t at) {
  ByteCursor cursor(chunk, file_.path());
  while (!cursor.at_end()) {
    const auto inner = static_cast<uint32_t>(cursor.position());
    const McapRecord record = next_record(cursor);
    if (record.op == McapOp::Message) {
      add_message(record.body, at, inner);
    } else if (record.op == McapOp::Schema || record.op == McapOp::Channel) {
      define(record.op, record.body);
    }
  }
}

}  // namespace

LogIndex index_mcap(const ByteFile& file) {
  return McapIndexer(file).index();
}

}  // namespace surefield
