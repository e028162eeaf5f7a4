// ROS 2's older bags are SQLite databases: topics(id, name, type, serialization_format, ...) and
// messages(topic_id, timestamp, data).
#include <fmt/format.h>
#include <sqlite3.h>

#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "engine/io/files.h"
#include "engine/logs/log_index.h"
#include "engine/logs/unpack.h"
#include "engine/logs/whole_pages.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr uint64_t kSmallestRow = 4;  // bytes of the file that a row takes at the least

struct CloseStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

/// The path as SQLite takes it with options: what has a meaning in them is written as a number.
std::string uri_of(const std::filesystem::path& file, bool untouched) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string())
    uri += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02x}", static_cast<unsigned>(c))
                                            : std::string(1, c);
  // A database that its writer left open has a second file with what came last; else nothing is locked or
  // written beside the recording.
  return uri + (untouched ? "?immutable=1" : "?mode=ro");
}

/// Where SQLite keeps what a writer has not yet put into the file itself.
std::filesystem::path journal_of(const std::filesystem::path& file) {
  return file.string() + "-wal";
}

Database open_database(const std::filesystem::path& file) {
  sqlite3* opened = nullptr;
  const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE;
  const int result = sqlite3_open_v2(uri_of(file, !file_exists(journal_of(file))).c_str(), &opened, flags,
                                     whole_pages_vfs(file));
  Database database(opened);
  if (result != SQLITE_OK) throw InputError(file, "cannot be opened as a database");
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestChunk));
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  // With this SQLite also opens a file that is shorter than its header says. Nothing can be written: it was
  // opened for reading.
  sqlite3_exec(opened, "PRAGMA writable_schema=ON; PRAGMA cell_size_check=ON; PRAGMA mmap_size=0", nullptr,
               nullptr, nullptr);
  return database;
}

class Db3Log : public MessageLog {
 public:
  explicit Db3Log(const std::filesystem::path& file) : file_(file), database_(open_database(file)) {
    IndexBuilder builder(file);
    require_tables();
    read_topics(builder);
    read_rows(builder);
    index_ = builder.finish();
    data_ = prepare("SELECT data FROM messages WHERE rowid = ?1");
    if (!data_) refuse();
  }

  std::string read(const MessagePlace& place) const override {
    const std::lock_guard lock(mutex_);
    sqlite3_reset(data_.get());
    sqlite3_bind_int64(data_.get(), 1, static_cast<sqlite3_int64>(place.at));
    if (sqlite3_step(data_.get()) != SQLITE_ROW)
      throw InputError(file_, fmt::format("is damaged: message {} cannot be read", place.at));
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(data_.get(), 0));
    const int count = sqlite3_column_bytes(data_.get(), 0);
    std::string message(bytes ? bytes : "", bytes ? static_cast<std::size_t>(count) : 0);
    sqlite3_reset(data_.get());
    return message;
  }

  std::string read_start(const MessagePlace& place, std::size_t count) const override {
    const std::lock_guard lock(mutex_);
    sqlite3_blob* opened = nullptr;
    const int result = sqlite3_blob_open(database_.get(), "main", "messages", "data",
                                         static_cast<sqlite3_int64>(place.at), 0, &opened);
    const std::unique_ptr<sqlite3_blob, decltype(&sqlite3_blob_close)> blob(opened, &sqlite3_blob_close);
    if (result != SQLITE_OK)
      throw InputError(file_, fmt::format("is damaged: message {} cannot be read", place.at));
    const auto size = static_cast<std::size_t>(sqlite3_blob_bytes(opened));
    std::string bytes(std::min(size, count), '\0');
    if (sqlite3_blob_read(opened, bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK)
      throw InputError(file_, fmt::format("is damaged: message {} cannot be read", place.at));
    return bytes;
  }

 private:
  Statement prepare(const char* query) const {
    sqlite3_stmt* prepared = nullptr;
    sqlite3_prepare_v2(database_.get(), query, -1, &prepared, nullptr);
    return Statement(prepared);
  }

  [[noreturn]] void refuse() const {
    throw InputError(file_, std::string("cannot be read as a ROS 2 bag: ") + sqlite3_errmsg(database_.get()));
  }

  /// A view of that name could compute for ever.
  void require_tables() const {
    const Statement tables = prepare(
        "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND rootpage > 0 AND sql NOT LIKE "
        "'%VIRTUAL%' "
        "AND name IN ('topics', 'messages')");
    if (!tables || sqlite3_step(tables.get()) != SQLITE_ROW) refuse();
    if (sqlite3_column_int(tables.get(), 0) != 2)
      throw InputError(file_, "is no ROS 2 bag: it has no tables topics and messages");
  }

  static std::string text(sqlite3_stmt* row, int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
    return text ? text : "";
  }

  void read_topics(IndexBuilder& builder) {
    const Statement topics = prepare("SELECT id, name, type, serialization_format FROM topics NOT INDEXED");
    if (!topics) refuse();
    while (sqlite3_step(topics.get()) == SQLITE_ROW)
      topics_[sqlite3_column_int64(topics.get(), 0)] =
          builder.topic(text(topics.get(), 1), text(topics.get(), 2), text(topics.get(), 3));
  }

  /// Where a page in the middle is damaged the rows behind it are read from the end on.
  void read_rows(IndexBuilder& builder) {
    std::error_code ignored;
    rows_left_ = std::filesystem::file_size(file_, ignored) / kSmallestRow;
    if (file_exists(journal_of(file_)))
      rows_left_ += std::filesystem::file_size(journal_of(file_), ignored) / kSmallestRow;
    const std::optional<int64_t> last = read_rows(
        builder, prepare("SELECT rowid, topic_id, timestamp FROM messages NOT INDEXED ORDER BY rowid"), {});
    if (complete_ && !unknown_) return;
    if (!complete_)
      read_rows(builder,
                prepare("SELECT rowid, topic_id, timestamp FROM messages NOT INDEXED ORDER BY rowid DESC"),
                last);
    builder.warn(fmt::format("{}: it is damaged or cut off; {} messages can be found", file_.string(),
                             builder.messages()));
  }

  /// Reads rows up to the one with id `end`; returns the id of the last.
  std::optional<int64_t> read_rows(IndexBuilder& builder, const Statement& rows, std::optional<int64_t> end) {
    if (!rows) refuse();
    std::optional<int64_t> last;
    int result = SQLITE_ROW;
    while (rows_left_ > 0 && (result = sqlite3_step(rows.get())) == SQLITE_ROW) {
      --rows_left_;
      const int64_t id = sqlite3_column_int64(rows.get(), 0);
      if (end && id <= *end) break;
      last = id;
      const auto topic = topics_.find(sqlite3_column_int64(rows.get(), 1));
      if (topic == topics_.end()) {
        unknown_ = true;
        continue;
      }
      builder.add({sqlite3_column_int64(rows.get(), 2), static_cast<uint64_t>(id), MessagePlace::kNoChunk,
                   topic->second});
    }
    complete_ = result == SQLITE_DONE;
    return last;
  }

  std::filesystem::path file_;
  Database database_;
  std::map<int64_t, uint16_t> topics_;
  uint64_t rows_left_ = 0;  ///< a damaged file could lead in circles
  bool complete_ = false;
  bool unknown_ = false;      ///< whether a message is of a topic that is not there
  mutable std::mutex mutex_;  ///< guards the connection and its statement
  Statement data_;
};

}  // namespace

std::unique_ptr<MessageLog> open_db3(const std::filesystem::path& file) {
  return std::make_unique<Db3Log>(file);
}

}  // namespace surefield
