// The same clip as a folder and in logs of every kind.
#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/sources/log_contents.h"
#include "tests/sources/log_scene.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr int kFrames = 5;
constexpr int64_t kDepthLater = 6000000;  // nanoseconds
const std::vector<double> kDistortion = {0.1, -0.2, 0.001, 0.002, 0.05};

std::string encoded(const char* extension, const cv::Mat& image) {
  std::vector<uchar> bytes;
  REQUIRE(cv::imencode(extension, image, bytes));
  return {bytes.begin(), bytes.end()};
}

cv::Mat swapped(const cv::Mat& colour) {
  cv::Mat bgr;
  cv::cvtColor(colour, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

/// The clip in TUM's layout.
void write_folder(const TemporaryFolder& folder) {
  std::string rgb, depth, truth;
  for (int i = 0; i < kFrames; ++i) {
    const int64_t stamp = kLogStart + i * kFrameTime;
    const auto seconds = [](int64_t ns) { return fmt::format("{}.{:09}", ns / 1000000000, ns % 1000000000); };
    folder.write(fmt::format("rgb/{}.png", i), encoded(".png", swapped(random_colour(i))));
    folder.write(fmt::format("depth/{}.png", i), encoded(".png", random_depth(i)));
    rgb += fmt::format("{} rgb/{}.png\n", seconds(stamp), i);
    depth += fmt::format("{} depth/{}.png\n", seconds(stamp + kDepthLater), i);
    truth += fmt::format("{} {} 2 3 0 0 0 1\n", seconds(stamp), i);
  }
  folder.write("rgb.txt", rgb);
  folder.write("depth.txt", depth);
  folder.write("groundtruth.txt", truth);
  folder.write("camera.yaml",
               fmt::format("width: 32\nheight: 24\nfx: 30\nfy: 31\ncx: 15.5\ncy: 11.5\ndepth_unit: 0.001\n"
                           "distortion: [{}]\n",
                           fmt::join(kDistortion, ", ")));
}

/// How the images of the clip are logged.
enum class Images { Raw, Png, Float };

/// The clip as messages, by the names of RealSense's driver.
std::vector<WrittenMessage> clip_messages(Wire wire, Images images) {
  const std::string frame = "camera_color_optical_frame",
                    aligned = "/camera/aligned_depth_to_color/image_raw";
  std::vector<WrittenMessage> messages;
  messages.push_back(
      camera_message({"/camera/color/camera_info", frame, kLogStart}, kLogCamera, kDistortion, wire));
  for (int i = 0; i < kFrames; ++i) {
    const ImagePlace colour{"/camera/color/image_raw", frame, kLogStart + i * kFrameTime};
    const ImagePlace depth{aligned, frame, colour.stamp + kDepthLater};
    if (images == Images::Png) {
      messages.push_back(compressed_message({colour.topic + "/compressed", frame, colour.stamp},
                                            encoded(".png", swapped(random_colour(i))),
                                            "rgb8; png compressed bgr8", wire));
      messages.push_back(compressed_message({aligned + "/compressedDepth", frame, depth.stamp},
                                            std::string(12, '\0') + encoded(".png", random_depth(i)),
                                            "16UC1; compressedDepth png", wire));
    } else {
      messages.push_back(image_message(colour, random_colour(i), "rgb8", wire));
      cv::Mat steps = random_depth(i), metres(steps.size(), CV_32FC1);
      for (std::size_t n = 0; n < steps.total(); ++n)
        metres.at<float>(static_cast<int>(n)) =
            static_cast<float>(steps.at<uint16_t>(static_cast<int>(n)) * 0.001);
      messages.push_back(images == Images::Raw ? image_message(depth, steps, "16UC1", wire)
                                               : image_message(depth, metres, "32FC1", wire));
    }
    messages.push_back(message("/ground_truth/pose", "geometry_msgs/PoseStamped", colour.stamp, wire,
                               [&](MessageWriter& writer) {
                                 writer.header(colour.stamp, "world").doubles({double(i), 2, 3, 0, 0, 0, 1});
                               }));
  }
  return messages;
}

void check_same(const std::filesystem::path& log, const Dataset& folder, const std::string& format,
                const std::string& warning = "") {
  const Dataset opened = open_dataset(log);
  CHECK(opened.recording->format() == format);
  CHECK(contains(joined(opened.recording->warnings()), warning));
  CHECK(opened.recording->warnings().size() == (warning.empty() ? 0 : 1));
  check_same_frames(*opened.recording, *folder.recording);
  REQUIRE(opened.truth());
  REQUIRE(opened.truth()->size() == folder.truth()->size());
  for (std::size_t i = 0; i < opened.truth()->size(); ++i) {
    CHECK((*opened.truth())[i].timestamp == (*folder.truth())[i].timestamp);
    CHECK((*opened.truth())[i].camera_to_world.matrix() == (*folder.truth())[i].camera_to_world.matrix());
  }
}

}  // namespace

TEST_CASE("the same clip gives the same frames from a folder and from every kind of log") {
  const TemporaryFolder folder, logs;
  write_folder(folder);
  const Dataset expected = open_dataset(folder.path());
  for (const Images images : {Images::Raw, Images::Png, Images::Float}) {
    CAPTURE(static_cast<int>(images));
    const auto ros2 = clip_messages(Wire::Cdr, images), ros1 = clip_messages(Wire::Ros1, images);
    for (const char* packing : {"", "lz4", "zstd"})
      check_same(logs.write("a.mcap", mcap_of(ros2, {.packing = packing})), expected, "mcap");
    check_same(logs.write("a.mcap", mcap_of(ros2, {.packing = "zstd", .index = false})), expected, "mcap",
               "it has no end");
    for (const char* packing : {"none", "bz2", "lz4"})
      check_same(logs.write("a.bag", bag_of(ros1, {.packing = packing})), expected, "bag");
    write_db3(logs / "a.db3", ros2);
    check_same(logs / "a.db3", expected, "db3");
  }
}

TEST_CASE("a folder that holds a log is opened as the log, unless the images lie there too") {
  const TemporaryFolder folder("walk");
  folder.write("walk_0.mcap", mcap_of(clip_messages(Wire::Cdr, Images::Raw)));
  CHECK(open_dataset(folder.path()).recording->name() == "walk");
  CHECK(open_dataset(folder.path()).recording->format() == "mcap");
  CHECK(open_dataset(folder / "walk_0.mcap").recording->name() == "walk_0");
  write_folder(folder);
  CHECK(open_dataset(folder.path()).recording->format() == "tum");
}

TEST_CASE("messages packed one by one are unpacked") {
  const TemporaryFolder folder, logs;
  write_folder(folder);
  std::vector<WrittenMessage> messages = clip_messages(Wire::Cdr, Images::Raw);
  for (WrittenMessage& message : messages) message.bytes = packed(message.bytes, "zstd");
  write_db3(logs / "a.db3", messages);
  check_same(logs / "a.db3", open_dataset(folder.path()), "db3");
}

TEST_CASE("topics are listed with their use, chosen by name where there are several, and by option") {
  const TemporaryFolder logs;
  std::vector<WrittenMessage> messages = clip_messages(Wire::Cdr, Images::Raw);
  for (int i = 0; i < kFrames; ++i) {
    const int64_t stamp = kLogStart + i * kFrameTime;
    messages.push_back(image_message({"/camera/infra1/image_rect_raw", "infra", stamp},
                                     cv::Mat(24, 32, CV_8UC1, cv::Scalar(9)), "mono8", Wire::Cdr));
    messages.push_back(image_message({"/other/rgb", "camera_color_optical_frame", stamp},
                                     cv::Mat(24, 32, CV_8UC3, cv::Scalar(1, 2, 3)), "bgr8", Wire::Cdr));
  }
  const auto file = logs.write("a.mcap", mcap_of(messages, {.packing = "lz4"}));
  std::string uses;
  for (const ListedTopic& listed : list_topics(file))
    uses +=
        fmt::format("{} {} {} {}\n", listed.topic.name, listed.topic.type, listed.topic.messages, listed.use);
  CHECK(uses ==
        "/camera/aligned_depth_to_color/image_raw sensor_msgs/Image 5 depth\n"
        "/camera/color/camera_info sensor_msgs/CameraInfo 1 camera of colour\n"
        "/camera/color/image_raw sensor_msgs/Image 5 colour\n"
        "/camera/infra1/image_rect_raw sensor_msgs/Image 5 \n"
        "/ground_truth/pose geometry_msgs/PoseStamped 5 poses\n"
        "/other/rgb sensor_msgs/Image 5 \n");
  const Dataset opened = open_dataset(file);
  CHECK(contains(joined(opened.recording->assumptions()),
                 "of 3 topics that could be colour, it is /camera/color/image_raw; --colour-topic"));
  const Dataset other = open_dataset(file, {.colour_topic = "/other/rgb"});
  CHECK(other.recording->load(0).frame->colour.at<cv::Vec3b>(5, 5) == cv::Vec3b(3, 2, 1));
  CHECK(contains(input_error([&] { open_dataset(file, {.colour_topic = "/nowhere"}); }),
                 "--colour-topic /nowhere is not in the log; its topics with images: "));
  CHECK(contains(input_error([&] { open_dataset(file, {.depth_topic = "/ground_truth/pose"}); }),
                 "holds no images"));
  const TemporaryFolder folder;
  write_folder(folder);
  CHECK(contains(input_error([&] { open_dataset(folder.path(), {.depth_topic = "/a"}); }), "has no topics"));
}

TEST_CASE("a log without images says what it has") {
  const TemporaryFolder logs;
  const auto file =
      logs.write("a.mcap", mcap_of({message("/chatter", "std_msgs/String", 5, Wire::Cdr,
                                            [](MessageWriter& writer) { writer.text("hello"); })}));
  CHECK(contains(input_error([&] { open_dataset(file); }), "it has /chatter (std_msgs/String)"));
  REQUIRE(list_topics(file).size() == 1);
  CHECK(list_topics(file)[0].use.empty());
}

TEST_CASE("a damaged image costs its frame, a log that was cut off the rest, and both are said") {
  const TemporaryFolder logs;
  std::vector<WrittenMessage> messages = clip_messages(Wire::Cdr, Images::Png);
  messages[4].bytes.back() = static_cast<char>(messages[4].bytes.back() ^ 1);  // the colour of frame 1
  const Dataset damaged = open_dataset(logs.write("a.mcap", mcap_of(messages)));
  CHECK(damaged.recording->count() == kFrames);
  CHECK(damaged.recording->load(0).frame);
  CHECK(contains(damaged.recording->load(1).problem, "a.mcap (/camera/color/image_raw/compressed"));
  const std::string bytes =
      bag_of(clip_messages(Wire::Ros1, Images::Raw), {.packing = "lz4", .index = false});
  const Dataset cut = open_dataset(logs.write("cut.bag", bytes.substr(0, bytes.size() - 2000)));
  CHECK(cut.recording->count() < kFrames);
  CHECK(cut.recording->count() >= 3);
  CHECK(contains(joined(cut.recording->warnings()), "damaged or cut off"));
}

TEST_CASE("images without stamps take those of the log") {
  const TemporaryFolder logs;
  std::vector<WrittenMessage> messages = clip_messages(Wire::Cdr, Images::Raw);
  for (WrittenMessage& message : messages)
    if (message.type == "sensor_msgs/Image") message.bytes.replace(4, 8, std::string(8, '\0'));
  const Dataset opened = open_dataset(logs.write("a.mcap", mcap_of(messages)));
  CHECK(opened.recording->timestamp(0) == 1305031102.175304);
  CHECK(contains(joined(opened.recording->assumptions()), "have no stamps"));
}
