// Logs as the programs of others write them, from the descriptions of the formats.
#include "tests/support/log_writers.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <map>
#include <stdexcept>

namespace surefield::test {

namespace {

template <typename T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void put_counted(std::string& bytes, std::string_view part) {
  put(bytes, static_cast<uint32_t>(part.size()));
  bytes += part;
}

std::string mcap_record(uint8_t op, const std::string& body) {
  std::string record(1, static_cast<char>(op));
  put(record, static_cast<uint64_t>(body.size()));
  return record + body;
}

/// The numbers of topics in the order in which they first come.
struct Topics {
  std::map<std::string, uint16_t> numbers;
  std::vector<const WrittenMessage*> first;

  explicit Topics(const std::vector<WrittenMessage>& messages) {
    for (const WrittenMessage& message : messages)
      if (numbers.emplace(message.topic, static_cast<uint16_t>(first.size())).second)
        first.push_back(&message);
  }
};

/// "sensor_msgs/Image" as ROS 2 writes it.
std::string with_msg(const std::string& type) {
  return std::string(type).insert(type.find('/'), "/msg");
}

std::string mcap_definitions(const WrittenMessage& first, uint16_t number, bool ros1) {
  std::string schema, channel;
  put(schema, static_cast<uint16_t>(number + 1));
  put_counted(schema, ros1 ? first.type : with_msg(first.type));
  put_counted(schema, ros1 ? "ros1msg" : "ros2msg");
  put_counted(schema, "# its fields");
  put(channel, number);
  put(channel, static_cast<uint16_t>(number + 1));
  put_counted(channel, first.topic);
  put_counted(channel, ros1 ? "ros1" : "cdr");
  put_counted(channel, "");
  return mcap_record(3, schema) + mcap_record(4, channel);
}

std::string mcap_message(const WrittenMessage& message, uint16_t channel) {
  std::string body;
  put(body, channel);
  put(body, uint32_t{0});
  put(body, message.stamp);
  put(body, message.stamp);
  return mcap_record(5, body + message.bytes);
}

/// A file while it is written.
struct McapFile {
  const LogStyle& style;
  std::string bytes = "\x89MCAP0\r\n";
  std::string chunk = {};
  std::map<uint16_t, std::string> chunk_index = {};
  std::string chunk_places = {};
  int64_t first = 0, last = 0;

  void end_chunk() {
    if (chunk.empty()) return;
    const std::string stored = style.packing.empty() ? chunk : packed(chunk, style.packing);
    std::string body;
    put(body, first);
    put(body, last);
    put(body, static_cast<uint64_t>(chunk.size()));
    put(body, static_cast<uint32_t>(
                  crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size()))));
    put_counted(body, style.packing);
    put(body, static_cast<uint64_t>(stored.size()));
    const uint64_t at = bytes.size();
    bytes += mcap_record(6, body + stored);
    const uint64_t length = bytes.size() - at;
    std::string offsets;
    const uint64_t index_at = bytes.size();
    for (const auto& [channel, entries] : chunk_index) {
      if (!style.chunk_index) break;
      put(offsets, channel);
      put(offsets, static_cast<uint64_t>(bytes.size()));
      std::string index;
      put(index, channel);
      put_counted(index, entries);
      bytes += mcap_record(7, index);
    }
    std::string place;
    put(place, first);
    put(place, last);
    put(place, at);
    put(place, length);
    put_counted(place, offsets);
    put(place, static_cast<uint64_t>(bytes.size()) - index_at);
    put_counted(place, style.packing);
    put(place, static_cast<uint64_t>(stored.size()));
    put(place, static_cast<uint64_t>(chunk.size()));
    chunk_places += mcap_record(8, place);
    chunk.clear();
    chunk_index.clear();
  }
};

}  // namespace

std::string packed(const std::string& bytes, const std::string& packing) {
  std::string out(2 * bytes.size() + 1000, '\0');
  std::size_t size = 0;
  if (packing == "lz4" || packing == "roslz4") {
    // ROS 1 reads no other frames than those of blocks that stand alone, with a checksum.
    LZ4F_preferences_t ros{};
    ros.frameInfo.blockMode = LZ4F_blockIndependent;
    ros.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    size = LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(),
                              packing == "roslz4" ? &ros : nullptr);
  } else if (packing == "zstd") {
    size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1);
  } else if (packing == "bz2") {
    auto length = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &length, const_cast<char*>(bytes.data()),
                             static_cast<unsigned>(bytes.size()), 1, 0, 0);
    size = length;
  } else {
    return bytes;
  }
  out.resize(size);
  return out;
}

std::string mcap_of(const std::vector<WrittenMessage>& messages, const LogStyle& style) {
  const Topics topics(messages);
  McapFile file{style};
  std::string head;
  put_counted(head, style.ros1 ? "ros1" : "ros2");
  put_counted(head, "tests");
  file.bytes += mcap_record(1, head);
  std::string definitions;
  std::vector<bool> defined(topics.first.size());
  std::size_t in_chunk = 0;
  for (const WrittenMessage& message : messages) {
    const uint16_t channel = topics.numbers.at(message.topic);
    std::string& to = style.chunked ? file.chunk : file.bytes;
    if (!defined[channel]) {
      definitions += mcap_definitions(message, channel, style.ros1);
      to += mcap_definitions(message, channel, style.ros1);
      defined[channel] = true;
    }
    if (in_chunk == 0) file.first = message.stamp;
    file.last = message.stamp;
    put(file.chunk_index[channel], message.stamp);
    put(file.chunk_index[channel], static_cast<uint64_t>(file.chunk.size()));
    to += mcap_message(message, channel);
    if (++in_chunk % style.per_chunk == 0) file.end_chunk();
  }
  file.end_chunk();
  if (!style.index) return file.bytes;
  file.bytes += mcap_record(0x0f, std::string(4, '\0'));
  const uint64_t summary = file.bytes.size();
  std::string statistics;
  put(statistics, static_cast<uint64_t>(messages.size()));
  statistics += std::string(2 + 4 + 4 + 4 + 4 + 8 + 8 + 4, '\0');
  file.bytes += definitions + mcap_record(0x0b, statistics) + file.chunk_places;
  std::string footer;
  put(footer, summary);
  footer += std::string(8 + 4, '\0');
  return file.bytes + mcap_record(2, footer) + "\x89MCAP0\r\n";
}

namespace {

std::string bag_field(const std::string& name, const std::string& value) {
  std::string field;
  put_counted(field, name + "=" + value);
  return field;
}

template <typename T>
std::string bag_number(const std::string& name, T value) {
  std::string bytes;
  put(bytes, value);
  return bag_field(name, bytes);
}

std::string bag_record(uint8_t op, const std::string& fields, const std::string& data) {
  std::string record;
  put_counted(record, bag_number("op", op) + fields);
  put_counted(record, data);
  return record;
}

uint64_t bag_time(int64_t stamp) {
  return static_cast<uint64_t>(stamp / 1000000000) | static_cast<uint64_t>(stamp % 1000000000) << 32;
}

std::string bag_connection(const WrittenMessage& first, uint32_t number) {
  return bag_record(7, bag_number("conn", number) + bag_field("topic", first.topic),
                    bag_field("topic", first.topic) + bag_field("type", first.type) +
                        bag_field("md5sum", "0123456789abcdef0123456789abcdef") +
                        bag_field("message_definition", "# its fields"));
}

/// The record at the beginning of a bag, which is filled up with blanks to a fixed length.
std::string bag_head(uint64_t index_at, uint32_t connections, uint32_t chunks) {
  const std::string fields = bag_number("index_pos", index_at) + bag_number("conn_count", connections) +
                             bag_number("chunk_count", chunks);
  const std::string empty = bag_record(3, fields, "");
  return bag_record(3, fields, std::string(4096 - empty.size(), ' '));
}

}  // namespace

std::string bag_of(const std::vector<WrittenMessage>& messages, const LogStyle& style) {
  const Topics topics(messages);
  const std::string magic = "#ROSBAG V2.0\n";
  std::string body, infos;
  std::vector<bool> defined(topics.first.size());
  uint32_t chunks = 0;
  const uint64_t start = magic.size() + bag_head(0, 0, 0).size();
  for (std::size_t i = 0; i < messages.size(); i += style.per_chunk) {
    std::string chunk;
    std::map<uint32_t, std::string> index;
    for (std::size_t j = i; j < std::min(messages.size(), i + style.per_chunk); ++j) {
      const uint32_t connection = topics.numbers.at(messages[j].topic);
      if (!defined[connection]) chunk += bag_connection(messages[j], connection);
      defined[connection] = true;
      put(index[connection], bag_time(messages[j].stamp));
      put(index[connection], static_cast<uint32_t>(chunk.size()));
      chunk += bag_record(2, bag_number("conn", connection) + bag_number("time", bag_time(messages[j].stamp)),
                          messages[j].bytes);
    }
    const uint64_t at = start + body.size();
    body += bag_record(
        5, bag_field("compression", style.packing) + bag_number("size", static_cast<uint32_t>(chunk.size())),
        packed(chunk, style.packing == "lz4" ? "roslz4" : style.packing));
    std::string counts;
    for (const auto& [connection, entries] : index) {
      const auto count = static_cast<uint32_t>(entries.size() / 12);
      body += bag_record(
          4, bag_number("ver", uint32_t{1}) + bag_number("conn", connection) + bag_number("count", count),
          entries);
      put(counts, connection);
      put(counts, count);
    }
    infos += bag_record(6,
                        bag_number("ver", uint32_t{1}) + bag_number("chunk_pos", at) +
                            bag_number("start_time", bag_time(messages[i].stamp)) +
                            bag_number("end_time", bag_time(messages[i].stamp)) +
                            bag_number("count", static_cast<uint32_t>(index.size())),
                        counts);
    ++chunks;
  }
  if (!style.index) return magic + bag_head(0, 0, 0) + body;
  std::string connections;
  for (std::size_t i = 0; i < topics.first.size(); ++i)
    connections += bag_connection(*topics.first[i], static_cast<uint32_t>(i));
  return magic + bag_head(start + body.size(), static_cast<uint32_t>(topics.first.size()), chunks) + body +
         connections + infos;
}

void write_db3(const std::filesystem::path& file, const std::vector<WrittenMessage>& messages) {
  std::filesystem::remove(file);
  sqlite3* database = nullptr;
  const auto run = [&](const char* statement) {
    if (sqlite3_exec(database, statement, nullptr, nullptr, nullptr) != SQLITE_OK)
      throw std::runtime_error(sqlite3_errmsg(database));
  };
  if (sqlite3_open(file.c_str(), &database) != SQLITE_OK) throw std::runtime_error("no database");
  run("PRAGMA synchronous=OFF; PRAGMA journal_mode=MEMORY");
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT "
      "NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
      "data BLOB "
      "NOT NULL);"
      "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
      "BEGIN");
  const Topics topics(messages);
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO topics VALUES (?1, ?2, ?3, 'cdr', '')", -1, &statement, nullptr);
  for (std::size_t i = 0; i < topics.first.size(); ++i) {
    const std::string type = with_msg(topics.first[i]->type);
    sqlite3_bind_int64(statement, 1, static_cast<sqlite3_int64>(i + 1));
    sqlite3_bind_text(statement, 2, topics.first[i]->topic.c_str(), -1, SQLITE_TRANSIENT);
    sqlite3_bind_text(statement, 3, type.c_str(), -1, SQLITE_TRANSIENT);
    sqlite3_step(statement);
    sqlite3_reset(statement);
  }
  sqlite3_finalize(statement);
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES (?1, ?2, ?3)", -1,
                     &statement, nullptr);
  for (const WrittenMessage& message : messages) {
    sqlite3_bind_int64(statement, 1, topics.numbers.at(message.topic) + 1);
    sqlite3_bind_int64(statement, 2, message.stamp);
    sqlite3_bind_blob(statement, 3, message.bytes.data(), static_cast<int>(message.bytes.size()),
                      SQLITE_TRANSIENT);
    sqlite3_step(statement);
    sqlite3_reset(statement);
  }
  sqlite3_finalize(statement);
  run("COMMIT");
  sqlite3_close(database);
}

}  // namespace surefield::test
