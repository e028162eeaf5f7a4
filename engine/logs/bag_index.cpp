// ROS 1 bags, version 2.0 (wiki.ros.org/Bags/Format/2.0): records of a head of named fields and data.
// Messages lie in chunks, with an index behind each; connections, which name topics, and the places of the
// chunks stand at the end.
#include "engine/logs/bag_index.h"

#include <algorithm>
#include <map>
#include <vector>

#include "engine/logs/bag_format.h"
#include "engine/logs/log_index.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

class BagIndexer {
 public:
  explicit BagIndexer(const ByteFile& file) : file_(file), builder_(file.path()) {}

  LogIndex index() {
    const std::string magic = file_.read_up_to(0, kBagMagic.size());
    if (magic != kBagMagic) {
      throw InputError(file_.path(), magic.starts_with("#ROSBAG V1")
                                         ? "is a bag of version 1; make it one of 2.0 with `rosbag migrate`"
                                         : "is no ROS 1 bag: it does not begin as one");
    }
    refuse_encrypted();
    if (!by_index()) {
      builder_ = IndexBuilder(file_.path());
      topics_.clear();
      by_reading();
    }
    return builder_.finish();
  }

 private:
  void refuse_encrypted() const;

  // By the index at the end.
  bool by_index();
  uint64_t index_bag_chunk(uint64_t at);

  // From front to back.
  void by_reading();
  uint64_t read_records();
  void read_record(const BagRecord& record, uint64_t at);

  void connect(const BagFields& fields, std::string_view data);
  void add_message(const BagFields& fields, uint64_t at, uint32_t inner);
  void scan_chunk(std::string_view chunk, uint64_t at);
  uint16_t topic_of(uint32_t connection) const;

  const ByteFile& file_;
  IndexBuilder builder_;
  std::map<uint32_t, uint16_t> topics_;  ///< by connection
};

void BagIndexer::connect(const BagFields& fields, std::string_view data) {
  const BagFields details(data, file_.path());
  topics_[fields.number<uint32_t>("conn")] =
      builder_.topic(fields.text("topic"), details.text("type"), "ros1");
}

uint16_t BagIndexer::topic_of(uint32_t connection) const {
  const auto topic = topics_.find(connection);
  if (topic == topics_.end()) throw InputError(file_.path(), "is damaged: a message has no connection");
  return topic->second;
}

void BagIndexer::add_message(const BagFields& fields, uint64_t at, uint32_t inner) {
  builder_.add({fields.stamp("time"), at, inner, topic_of(fields.number<uint32_t>("conn"))});
}

void BagIndexer::refuse_encrypted() const {
  bool encrypted = false;
  try {
    const BagRecord first = read_bag_record(file_, kBagMagic.size());
    encrypted = !BagFields(first.head, file_.path()).text("encryptor").empty();
  } catch (const InputError&) {
    return;  // what reads it says what is wrong
  }
  if (encrypted) throw InputError(file_.path(), "is encrypted; `rosbag decrypt` writes a bag that is not");
}

/// False where the index is missing or damaged, or does not hold all that the file announces.
bool BagIndexer::by_index() {
  try {
    const BagRecord first = read_bag_record(file_, kBagMagic.size());
    const BagFields fields(first.head, file_.path());
    if (fields.op() != BagOp::File) return false;
    const auto connections = fields.number<uint32_t>("conn_count");
    const auto chunks = fields.number<uint32_t>("chunk_count");
    std::vector<uint64_t> places;
    uint64_t at = fields.number<uint64_t>("index_pos");
    if (at == 0) return false;
    while (at < file_.size()) {
      const BagRecord record = read_bag_record(file_, at);
      const BagFields head(record.head, file_.path());
      if (head.op() == BagOp::Connection) connect(head, file_.read(record.data_at, record.data_size));
      if (head.op() == BagOp::ChunkInfo) places.push_back(head.number<uint64_t>("chunk_pos"));
      at = record.end();
    }
    std::sort(places.begin(), places.end());
    uint64_t end = 0;
    for (const uint64_t place : places) {
      if (place < end) return false;  // two chunks in one place
      end = index_bag_chunk(place);
    }
    return places.size() == chunks && topics_.size() == connections;
  } catch (const InputError&) {
    return false;
  }
}

/// Reads the indexes that follow a chunk, one for each connection; returns where they end.
uint64_t BagIndexer::index_bag_chunk(uint64_t chunk) {
  const std::size_t before = builder_.messages();
  uint64_t at = read_bag_record(file_, chunk).end();
  while (at < file_.size()) {
    const BagRecord record = read_bag_record(file_, at);
    const BagFields head(record.head, file_.path());
    if (head.op() != BagOp::Index) break;
    const uint16_t topic = topic_of(head.number<uint32_t>("conn"));
    const std::string entries = file_.read(record.data_at, record.data_size);
    ByteCursor cursor(entries, file_.path());
    while (!cursor.at_end()) {
      const int64_t stamp = bag_stamp(cursor.number<uint64_t>());
      builder_.add({stamp, chunk, cursor.number<uint32_t>(), topic});
    }
    at = record.end();
  }
  builder_.sort_from(before);
  return at;
}

void BagIndexer::by_reading() {
  const uint64_t end = read_records();
  if (builder_.messages() == 0 && topics_.empty() && end < file_.size())
    throw InputError(file_.path(), "nothing in it can be read; it may be damaged, or cut off at once");
  builder_.warn_of_losses(end, file_.size(), "it has no index, as where the recorder was stopped");
}

/// Goes from record to record; returns where it could not go on, or the size of the file.
uint64_t BagIndexer::read_records() {
  uint64_t at = kBagMagic.size();
  while (at < file_.size()) {
    try {
      const BagRecord record = read_bag_record(file_, at);
      read_record(record, at);
      at = record.end();
    } catch (const InputError&) {
      return at;
    }
  }
  return at;
}

void BagIndexer::read_record(const BagRecord& record, uint64_t at) {
  const BagFields fields(record.head, file_.path());
  const BagOp op = fields.op();
  if (op == BagOp::Connection) {
    connect(fields, file_.read(record.data_at, record.data_size));
  } else if (op == BagOp::Message) {
    add_message(fields, at, MessagePlace::kNoChunk);
  } else if (op == BagOp::Chunk) {
    builder_.add_chunk([&] { scan_chunk(unpack_bag_chunk(file_, record), at); });
  }
}

void BagIndexer::scan_chunk(std::string_view chunk, uint64_t at) {
  ByteCursor cursor(chunk, file_.path());
  while (!cursor.at_end()) {
    const auto inner = static_cast<uint32_t>(cursor.position());
    const BagRecordView record = next_bag_record(cursor);
    const BagFields fields(record.head, file_.path());
    if (fields.op() == BagOp::Connection) connect(fields, record.data);
    if (fields.op() == BagOp::Message) add_message(fields, at, inner);
  }
}

}  // namespace

LogIndex index_bag(const ByteFile& file) {
  return BagIndexer(file).index();
}

}  // namespace surefield
