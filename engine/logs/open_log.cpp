// Which files a log has, and several files as one log.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "engine/io/file_names.h"
#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/logs/log_index.h"
#include "engine/logs/unpack.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::array kExtensions = {".mcap", ".db3", ".bag"};
constexpr const char* kMetadata = "metadata.yaml";
constexpr std::size_t kMostParts = 10000;

bool is_log_name(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

/// The files that rosbag2's metadata.yaml lists: the items below relative_file_paths. Those that are not
/// there are passed over, as where only some were copied.
std::vector<std::filesystem::path> listed_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  bool listing = false;
  for (const TextLine& line : read_lines(folder / kMetadata)) {
    if (line.text.starts_with("relative_file_paths:")) {
      listing = true;
    } else if (listing && line.text.starts_with("- ")) {
      std::string name = line.text.substr(2);
      std::erase(name, '"');
      std::erase(name, '\'');
      const std::filesystem::path file = folder / std::filesystem::path(name).filename();
      if (is_log_name(file) && file_exists(file)) files.push_back(file);
    } else {
      listing = false;
    }
  }
  return files;
}

/// "walk_2.db3" without the number at the end of its stem.
std::string without_number(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const auto last = stem.find_last_not_of("0123456789");
  return stem.substr(0, last == std::string::npos ? 0 : last + 1) + lower_extension(file);
}

std::unique_ptr<MessageLog> open_part(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".mcap") return open_mcap(file);
  return extension == ".db3" ? open_db3(file) : open_bag(file);
}

/// Several files of one recording. One that cannot be read at all is a warning.
class SplitLog : public MessageLog {
 public:
  explicit SplitLog(const std::vector<std::filesystem::path>& files) {
    IndexBuilder builder(files.front().parent_path());
    for (const std::filesystem::path& file : files) {
      try {
        add(open_part(file), builder);
      } catch (const InputError& error) {
        builder.warn(fmt::format("a part is left out: {}", error.what()));
      }
    }
    if (parts_.empty()) throw InputError(files.front().parent_path(), "none of its files can be read");
    index_ = builder.finish();
  }

  std::string read(const MessagePlace& place) const override { return parts_.at(place.part)->read(place); }
  std::string read_start(const MessagePlace& place, std::size_t count) const override {
    return parts_.at(place.part)->read_start(place, count);
  }

 private:
  void add(std::unique_ptr<MessageLog> part, IndexBuilder& builder) {
    std::vector<uint16_t> numbers;
    for (const LogTopic& topic : part->topics())
      numbers.push_back(builder.topic(topic.name, topic.type, topic.encoding));
    for (MessagePlace place : part->messages()) {
      place.topic = numbers[place.topic];
      place.part = static_cast<uint16_t>(parts_.size());
      builder.add(place);
    }
    for (const std::string& warning : part->warnings()) builder.warn(warning);
    parts_.push_back(std::move(part));
  }

  std::vector<std::unique_ptr<MessageLog>> parts_;
};

}  // namespace

std::vector<std::filesystem::path> log_files(const std::filesystem::path& path) {
  if (!folder_exists(path)) {
    if (is_log_name(path)) return {path};
    return {};
  }
  if (file_exists(path / kMetadata)) {
    std::vector<std::filesystem::path> listed = listed_files(path);
    if (!listed.empty()) return listed;
  }
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& file : list_folder(path))
    if (is_log_name(file) && !folder_exists(file)) files.push_back(file);
  return files;
}

std::unique_ptr<MessageLog> open_log(const std::filesystem::path& path) {
  const std::vector<std::filesystem::path> files = log_files(path);
  if (files.empty()) throw InputError(path, "holds no log (.mcap, .db3 or .bag)");
  if (files.size() == 1) return open_part(files.front());
  const bool listed = file_exists(path / kMetadata) && !listed_files(path).empty();
  const std::string name = without_number(files.front());
  const bool one = std::all_of(files.begin(), files.end(), [&](const std::filesystem::path& file) {
    return without_number(file) == name;
  });
  if ((!listed && !one) || files.size() > kMostParts) {
    throw InputError(
        path, fmt::format("holds {} recordings ({}, {}, ...); give the path of one of them", files.size(),
                          files[0].filename().string(), files[1].filename().string()));
  }
  return std::make_unique<SplitLog>(files);
}

}  // namespace surefield
