#include "engine/sources/log_reader.h"

#include <fmt/format.h>

#include <utility>

#include "engine/logs/unpack.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kHeaderBytes = 1024;
constexpr std::size_t kTriedFirst = 20;  // messages of a topic of which one should be readable

}  // namespace

LogReader::LogReader(const std::filesystem::path& path) : path_(path), log_(open_log(path)) {
  for (const MessagePlace& place : log_->messages()) {
    std::vector<MessagePlace>& places = first_places_[place.topic];
    if (places.size() < kTriedFirst) places.push_back(place);
  }
}

std::optional<uint16_t> LogReader::find(const std::string& name) const {
  for (std::size_t i = 0; i < topics().size(); ++i)
    if (topics()[i].name == name && topics()[i].messages > 0) return static_cast<uint16_t>(i);
  return std::nullopt;
}

bool LogReader::is(uint16_t topic, const char* type) const {
  const LogTopic& known = topics().at(topic);
  return known.type == type && known.serialisation != Serialisation::Other;
}

std::vector<MessagePlace> LogReader::places(uint16_t topic) const {
  std::vector<MessagePlace> places;
  for (const MessagePlace& place : log_->messages())
    if (place.topic == topic) places.push_back(place);
  return places;
}

std::optional<OwnedMessage> LogReader::first(uint16_t topic) const {
  const auto places = first_places_.find(topic);
  if (places == first_places_.end()) return std::nullopt;
  for (const MessagePlace& place : places->second) {
    try {
      return read(place);
    } catch (const InputError&) {
      continue;  // the next may be whole
    }
  }
  return std::nullopt;
}

OwnedMessage LogReader::read(const MessagePlace& place) const {
  return owned(place, log_->read(place));
}

OwnedMessage LogReader::read_start(const MessagePlace& place) const {
  std::string bytes = log_->read_start(place, kHeaderBytes);
  if (is_zstd(bytes)) return read(place);
  return owned(place, std::move(bytes));
}

OwnedMessage LogReader::owned(const MessagePlace& place, std::string bytes) const {
  const LogTopic& topic = topics().at(place.topic);
  OwnedMessage message{
      std::move(bytes), topic.serialisation,
      fmt::format("{} ({}, {:.3f} s)", path_.string(), topic.name, static_cast<double>(place.stamp) * 1e-9)};
  // No message of CDR begins as a packed one does.
  if (topic.serialisation == Serialisation::Cdr && is_zstd(message.bytes))
    message.bytes = unpack_zstd_message(message.bytes, message.name);
  return message;
}

}  // namespace surefield
