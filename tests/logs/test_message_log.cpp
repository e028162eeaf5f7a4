// Logs of all kinds, as the writers of tests/support write them.
#include <fmt/format.h>

#include "engine/io/files.h"
#include "tests/logs/written_logs.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// The topic, "sensor_msgs/Image".
const LogTopic& topic_of(const MessageLog& log, const MessagePlace& place) {
  return log.topics().at(place.topic);
}

/// Whether the log holds exactly these messages, in this order.
void check_messages(const MessageLog& log, const std::vector<WrittenMessage>& expected) {
  REQUIRE(log.messages().size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const MessagePlace& place = log.messages()[i];
    CHECK(place.stamp == expected[i].stamp);
    CHECK(topic_of(log, place).name == expected[i].topic);
    CHECK(topic_of(log, place).type == expected[i].type);
    CHECK(log.read(place) == expected[i].bytes);
    const std::string start = log.read_start(place, 20);
    CHECK(start.size() >= 20);
    CHECK(expected[i].bytes.starts_with(start));
  }
}

std::string open_error(const std::filesystem::path& path) {
  return input_error([&] { open_log(path); });
}

}  // namespace

TEST_CASE("logs of all kinds give all of their messages") {
  const std::vector<WrittenMessage> messages = some_messages();
  for (const WrittenLog& kind : all_kinds()) {
    CAPTURE(name_of(kind));
    const TemporaryFolder folder;
    const auto log = open_log(folder.write("log" + kind.extension, bytes_of(kind, messages, folder)));
    check_messages(*log, messages);
    REQUIRE(log->topics().size() == 2);
    CHECK(log->topics()[0].messages + log->topics()[1].messages == messages.size());
    CHECK(log->topics()[0].encoding == (kind.extension == ".bag" ? "ros1" : "cdr"));
    CHECK(log->warnings().size() == (kind.style.index ? 0 : 1));
  }
}

TEST_CASE("messages come in the order of their stamps, of equal stamps in that of the file") {
  std::vector<WrittenMessage> messages = some_messages();
  std::vector<WrittenMessage> shuffled = {messages[4], messages[9], messages[0], messages[7], messages[2]};
  messages = {messages[0], messages[2], messages[4], messages[7], messages[9]};
  for (const WrittenLog& kind : all_kinds()) {
    CAPTURE(name_of(kind));
    const TemporaryFolder folder;
    check_messages(*open_log(folder.write("log" + kind.extension, bytes_of(kind, shuffled, folder))),
                   messages);
  }
  for (WrittenMessage& message : shuffled) message.stamp = 5;
  for (const WrittenLog& kind : all_kinds()) {
    CAPTURE(name_of(kind));
    const TemporaryFolder folder;
    check_messages(*open_log(folder.write("log" + kind.extension, bytes_of(kind, shuffled, folder))),
                   shuffled);
  }
}

TEST_CASE("a log that was split is one, by metadata.yaml or by its names") {
  const std::vector<WrittenMessage> messages = some_messages();
  const std::vector<WrittenMessage> first(messages.begin(), messages.begin() + 4);
  const std::vector<WrittenMessage> second(messages.begin() + 4, messages.end());
  const TemporaryFolder folder;
  write_db3(folder / "walk_0.db3", first);
  write_db3(folder / "walk_1.db3", second);
  check_messages(*open_log(folder.path()), messages);
  write_db3(folder / "other.db3", second);
  CHECK(contains(open_error(folder.path()), "holds 3 recordings"));
  folder.write("metadata.yaml",
               "rosbag2_bagfile_information:\n  relative_file_paths:\n    - walk_0.db3\n    - "
               "\"walk_1.db3\"\n  duration:\n");
  check_messages(*open_log(folder.path()), messages);
  check_messages(*open_log(folder / "walk_1.db3"), second);
  folder.write("walk_0.db3", "damaged");
  const auto rest = open_log(folder.path());
  check_messages(*rest, second);
  REQUIRE(rest->warnings().size() == 1);
  CHECK(contains(rest->warnings()[0], "a part is left out"));
}

TEST_CASE("a topic that several publish is one; its type is that of ROS 1 and 2 alike") {
  std::vector<WrittenMessage> messages = some_messages();
  const TemporaryFolder folder;
  const auto ros1 = open_log(folder.write("a.mcap", mcap_of(messages, {.ros1 = true})));
  check_messages(*ros1, messages);
  CHECK(ros1->topics()[0].serialisation == Serialisation::Ros1);
}

TEST_CASE("a database is opened whatever its path is named, and nothing is written beside it") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "50% of? #it");
  write_db3(folder / "50% of? #it/a.db3", some_messages());
  check_messages(*open_log(folder / "50% of? #it/a.db3"), some_messages());
  CHECK(list_folder(folder / "50% of? #it").size() == 1);
}

TEST_CASE("what is no log, or of a kind that cannot be read, says so") {
  const TemporaryFolder folder;
  CHECK(contains(open_error(folder.path()), "holds no log"));
  CHECK(contains(open_error(folder.write("a.mcap", "text")), "is no MCAP file"));
  CHECK(contains(open_error(folder.write("a.bag", "text")), "is no ROS 1 bag"));
  CHECK(contains(open_error(folder.write("a.bag", "#ROSBAG V1.2\n")), "rosbag migrate"));
  CHECK(contains(open_error(folder.write("a.db3", std::string(5000, 'x'))), "cannot be read as a ROS 2 bag"));
  CHECK(contains(open_error(folder / "missing.bag"), "cannot be opened"));
  std::filesystem::create_directories(folder / "folder.bag/x");
  CHECK(contains(open_error(folder / "folder.bag"), "holds no log"));
}

TEST_CASE("the logs of others are listed as they are") {
  const auto folder = real_clip("logs");
  if (folder.empty()) return;
  const auto names = [](const MessageLog& log) {
    std::string text;
    for (const LogTopic& topic : log.topics())
      text += fmt::format("{} {} {} {}\n", topic.name, topic.type, topic.encoding, topic.messages);
    return text;
  };
  const auto talker = open_log(folder / "talker.mcap");
  CHECK(contains(names(*talker), "/topic std_msgs/String cdr 10\n"));
  CHECK(talker->warnings().empty());
  CHECK(contains(names(*talker), "/rosout rcl_interfaces/Log cdr 10\n"));
  const auto few = open_log(folder / "only_topics.mcap");
  CHECK(contains(names(*few), "/parameter_events rcl_interfaces/ParameterEvent cdr 7\n"));
  CHECK(few->messages().size() == 7);
  CHECK(few->topics().size() == 3);
  CHECK(few->warnings().empty());
  const auto services = open_log(folder / "topics_and_services.db3");
  CHECK(contains(names(*services), "/events/write_split rosbag2_interfaces/WriteSplitEvent cdr 0\n"));
  CHECK(contains(names(*services),
                 "/add_two_ints/_service_event example_interfaces/srv/AddTwoInts_Event cdr 6\n"));
  CHECK(services->messages().size() == 13);
  CHECK(services->warnings().empty());
}
