#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "engine/logs/message_log.h"
#include "engine/types/error.h"

namespace surefield {

/// Fills a LogIndex: gives topics their numbers, and sorts at the end.
class IndexBuilder {
 public:
  /// `file` is what errors name.
  explicit IndexBuilder(const std::filesystem::path& file) : file_(file) {}

  /// The number of the topic of that name, type and encoding, which may be new. Throws InputError where there
  /// are more than any robot has.
  uint16_t topic(std::string_view name, std::string_view type, std::string_view encoding);

  void add(const MessagePlace& place) { index_.messages.push_back(place); }
  void warn(const std::string& line) { index_.warnings.push_back(line); }
  std::size_t messages() const { return index_.messages.size(); }
  /// Adds the messages of a chunk by scan(). Where it throws InputError, the chunk is damaged: that costs its
  /// messages alone, which are taken away again, since its record tells where the next one begins.
  template <typename Scan>
  void add_chunk(Scan scan) {
    const std::size_t before = messages();
    try {
      scan();
    } catch (const InputError&) {
      drop_from(before);
      ++damaged_chunks_;
    }
  }
  /// Warns of what a file lacks that was read from front to back, up to the byte `end` of `size`; of
  /// `otherwise`, unless it is empty, where all was read.
  void warn_of_losses(uint64_t end, uint64_t size, const std::string& otherwise);
  /// Takes the messages from the one of that number on away again.
  void drop_from(std::size_t first) { index_.messages.resize(first); }
  /// Puts them into the order in which they lie in the file.
  void sort_from(std::size_t first);

  /// The index, sorted, with the messages of each topic counted.
  LogIndex finish();

 private:
  std::filesystem::path file_;
  LogIndex index_;
  std::map<std::string, uint16_t> numbers_;
  int damaged_chunks_ = 0;
};

/// Sorts messages by their stamps; those of equal stamps keep their order.
void sort_by_stamp(std::vector<MessagePlace>& messages);

/// Counts the messages of each topic anew.
void count_messages(LogIndex& index);

// The logs of one file. Each throws InputError where the file is none of its kind or nothing of it can be
// read.
std::unique_ptr<MessageLog> open_mcap(const std::filesystem::path& file);
std::unique_ptr<MessageLog> open_db3(const std::filesystem::path& file);
std::unique_ptr<MessageLog> open_bag(const std::filesystem::path& file);

}  // namespace surefield
