#include "engine/logs/log_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kMostTopics = 50000;

/// "sensor_msgs/msg/Image" and "sensor_msgs::msg::dds_::Image_" are the same type in two spellings; the first
/// is what logs write.
std::string without_msg(std::string_view type) {
  std::string name(type);
  const auto at = name.find("/msg/");
  if (at != std::string::npos) name.erase(at, 4);
  return printable(name);
}

Serialisation serialisation_of(std::string_view encoding) {
  if (encoding == "cdr") return Serialisation::Cdr;
  return encoding == "ros1" ? Serialisation::Ros1 : Serialisation::Other;
}

}  // namespace

void IndexBuilder::warn_of_losses(uint64_t end, uint64_t size, const std::string& otherwise) {
  std::string lost;
  if (damaged_chunks_ > 0) lost = fmt::format("{} damaged chunks are left out", damaged_chunks_);
  if (end < size) {
    lost += fmt::format("{}the last {} of {} bytes are damaged or cut off", lost.empty() ? "" : ", ",
                        size - end, size);
  }
  if (lost.empty()) lost = otherwise;
  if (!lost.empty()) warn(fmt::format("{}: {}; {} messages can be read", file_.string(), lost, messages()));
}

uint16_t IndexBuilder::topic(std::string_view name, std::string_view type, std::string_view encoding) {
  const std::string key = std::string(name) + '\n' + std::string(type) + '\n' + std::string(encoding);
  const auto known = numbers_.find(key);
  if (known != numbers_.end()) return known->second;
  if (index_.topics.size() >= kMostTopics) throw InputError(file_, "is damaged: it has too many topics");
  const auto number = static_cast<uint16_t>(index_.topics.size());
  index_.topics.push_back({printable(std::string(name)), without_msg(type), serialisation_of(encoding),
                           printable(std::string(encoding))});
  numbers_.emplace(key, number);
  return number;
}

void IndexBuilder::sort_from(std::size_t first) {
  std::sort(index_.messages.begin() + static_cast<std::ptrdiff_t>(first), index_.messages.end(),
            [](const MessagePlace& a, const MessagePlace& b) {
              return std::tie(a.at, a.inner) < std::tie(b.at, b.inner);
            });
}

LogIndex IndexBuilder::finish() {
  sort_by_stamp(index_.messages);
  count_messages(index_);
  return std::move(index_);
}

void sort_by_stamp(std::vector<MessagePlace>& messages) {
  std::stable_sort(messages.begin(), messages.end(),
                   [](const MessagePlace& a, const MessagePlace& b) { return a.stamp < b.stamp; });
}

void count_messages(LogIndex& index) {
  for (LogTopic& topic : index.topics) topic.messages = 0;
  for (const MessagePlace& place : index.messages) ++index.topics.at(place.topic).messages;
}

}  // namespace surefield
