#include "engine/logs/mcap_writer.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>

#include "engine/logs/mcap_format.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kChunkBytes = std::size_t{4} << 20;  // of messages, before they are packed
constexpr int kPackingLevel = 1;
constexpr auto kHeader = static_cast<McapOp>(0x01);

template <typename T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void append_counted(std::string& bytes, std::string_view part) {
  append(bytes, static_cast<uint32_t>(part.size()));
  bytes += part;
}

std::string record(McapOp op, const std::string& body) {
  std::string bytes(1, static_cast<char>(op));
  append(bytes, static_cast<uint64_t>(body.size()));
  return bytes + body;
}

std::string pack_zstd(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kPackingLevel));
  return packed;
}

}  // namespace

McapWriter::McapWriter(std::filesystem::path file)
    : file_(std::move(file)), part_(file_.string() + ".part"), stream_(part_, std::ios::binary) {
  std::string head;
  append_counted(head, "ros2");
  append_counted(head, "surefield");
  put(std::string(kMcapMagic) + record(kHeader, head));
}

McapWriter::~McapWriter() {
  if (closed_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void McapWriter::put(const std::string& bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) throw InputError(part_, "cannot be written; is the folder there, and is the disk full?");
  written_ += bytes.size();
}

uint16_t McapWriter::add_topic(const std::string& name, const std::string& type,
                               const std::string& definition) {
  const auto number = static_cast<uint16_t>(topics_.size());
  const auto schema_number = static_cast<uint16_t>(number + 1);  // 0 is none
  std::string schema, channel;
  append(schema, schema_number);
  append_counted(schema, type);
  append_counted(schema, "ros2msg");
  append_counted(schema, definition);
  append(channel, number);
  append(channel, schema_number);
  append_counted(channel, name);
  append_counted(channel, "cdr");
  append_counted(channel, "");
  topics_.push_back({record(McapOp::Schema, schema) + record(McapOp::Channel, channel)});
  return number;
}

void McapWriter::write(uint16_t topic, int64_t stamp, std::string_view message) {
  if (topics_[topic].messages == 0) chunk_ += topics_[topic].definitions;
  const auto sequence = static_cast<uint32_t>(topics_[topic].messages++);
  if (chunk_index_.empty()) chunk_first_ = chunk_last_ = stamp;
  if (chunks_ == 0 && chunk_index_.empty()) first_ = last_ = stamp;
  chunk_first_ = std::min(chunk_first_, stamp);
  chunk_last_ = std::max(chunk_last_, stamp);
  append(chunk_index_[topic], stamp);
  append(chunk_index_[topic], static_cast<uint64_t>(chunk_.size()));
  std::string body;
  append(body, topic);
  append(body, sequence);
  append(body, stamp);  // when it was logged, and when it was published
  append(body, stamp);
  body += message;
  chunk_ += record(McapOp::Message, body);
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_index_.empty()) return;
  const std::string packed = pack_zstd(chunk_);
  const auto checksum = static_cast<uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(chunk_.data()), static_cast<uInt>(chunk_.size())));
  std::string body;
  append(body, chunk_first_);
  append(body, chunk_last_);
  append(body, static_cast<uint64_t>(chunk_.size()));
  append(body, checksum);
  append_counted(body, "zstd");
  append(body, static_cast<uint64_t>(packed.size()));
  const uint64_t at = written_;
  put(record(McapOp::Chunk, body + packed));
  const uint64_t indices_at = written_;
  std::string offsets;
  for (const auto& [topic, entries] : chunk_index_) {
    append(offsets, topic);
    append(offsets, written_);
    std::string index;
    append(index, topic);
    append_counted(index, entries);
    put(record(McapOp::MessageIndex, index));
  }
  std::string place;
  append(place, chunk_first_);
  append(place, chunk_last_);
  append(place, at);
  append(place, indices_at - at);
  append_counted(place, offsets);
  append(place, written_ - indices_at);
  append_counted(place, "zstd");
  append(place, static_cast<uint64_t>(packed.size()));
  append(place, static_cast<uint64_t>(chunk_.size()));
  chunk_places_ += record(McapOp::ChunkIndex, place);
  first_ = std::min(first_, chunk_first_);
  last_ = std::max(last_, chunk_last_);
  ++chunks_;
  chunk_.clear();
  chunk_index_.clear();
}

/// Topics, statistics, and where each chunk is.
std::string McapWriter::summary() const {
  std::string definitions, counts;
  uint64_t messages = 0;
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    definitions += topics_[topic].definitions;
    append(counts, static_cast<uint16_t>(topic));
    append(counts, topics_[topic].messages);
    messages += topics_[topic].messages;
  }
  std::string statistics;
  append(statistics, messages);
  append(statistics, static_cast<uint16_t>(topics_.size()));  // schemas
  append(statistics, static_cast<uint32_t>(topics_.size()));  // channels
  append(statistics, uint32_t{0});                            // attachments
  append(statistics, uint32_t{0});                            // metadata
  append(statistics, chunks_);
  append(statistics, first_);
  append(statistics, last_);
  append_counted(statistics, counts);
  return definitions + record(McapOp::Statistics, statistics) + chunk_places_;
}

void McapWriter::close() {
  end_chunk();
  put(record(McapOp::DataEnd, std::string(sizeof(uint32_t), '\0')));  // no checksum of the whole
  std::string footer;
  append(footer, written_);     // where the summary begins
  append(footer, uint64_t{0});  // no offsets of its parts
  append(footer, uint32_t{0});  // nor a checksum
  put(summary() + record(McapOp::Footer, footer) + std::string(kMcapMagic));
  stream_.close();
  std::error_code error;
  if (stream_) std::filesystem::rename(part_, file_, error);
  if (!stream_ || error) throw InputError(file_, "cannot be written; is the disk full?");
  closed_ = true;
}

}  // namespace surefield
