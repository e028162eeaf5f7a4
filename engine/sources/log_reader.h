#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/logs/message_log.h"
#include "engine/logs/messages.h"

namespace surefield {

/// A message and what is needed to decode it.
struct OwnedMessage {
  std::string bytes;
  Serialisation serialisation = Serialisation::Cdr;
  std::filesystem::path name;

  SerialisedMessage view() const { return {bytes, serialisation, name}; }
};

/// A log as recordings are made of it: messages by topic. May be used by any thread.
class LogReader {
 public:
  /// Throws InputError where nothing in the log can be read.
  explicit LogReader(const std::filesystem::path& path);

  const std::vector<LogTopic>& topics() const { return log_->topics(); }
  const std::vector<std::string>& warnings() const { return log_->warnings(); }
  const std::filesystem::path& path() const { return path_; }

  /// The topic of that name that has messages; nullopt where there is none.
  std::optional<uint16_t> find(const std::string& name) const;

  /// Whether a topic has that type and is serialised in a way that is read.
  bool is(uint16_t topic, const char* type) const;

  /// The messages of a topic in the order of their stamps.
  std::vector<MessagePlace> places(uint16_t topic) const;

  /// Its first message that can be read; nullopt where none can.
  std::optional<OwnedMessage> first(uint16_t topic) const;

  /// Throws InputError where the message is damaged; its errors name the log and the topic.
  OwnedMessage read(const MessagePlace& place) const;

  /// The beginning of a message, with its header.
  OwnedMessage read_start(const MessagePlace& place) const;

 private:
  OwnedMessage owned(const MessagePlace& place, std::string bytes) const;

  std::filesystem::path path_;
  std::unique_ptr<MessageLog> log_;
  std::map<uint16_t, std::vector<MessagePlace>> first_places_;  ///< of each topic
};

}  // namespace surefield
