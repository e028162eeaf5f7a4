#pragma once

#include <spdlog/sinks/base_sink.h>

#include <filesystem>
#include <mutex>
#include <string>

namespace surefield {

/// A log that survives its folder: where the file has vanished it is written again from the beginning.
class LogFile : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// Throws InputError where the file cannot be written.
  explicit LogFile(const std::filesystem::path& file);
  ~LogFile() override;

  /// Looks whether the file is still there.
  void restore();
  /// It has another name now.
  void moved_to(const std::filesystem::path& file);

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

 private:
  int open_file() const;

  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace surefield
