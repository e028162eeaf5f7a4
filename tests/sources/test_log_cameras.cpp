// Cameras of logs: lenses, depth that is not registered, what is missing, and true poses.
#include <fmt/format.h>

#include "engine/sources/depth_registration.h"
#include "engine/sources/layouts.h"
#include "tests/sources/log_scene.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr Intrinsics kDepthCamera = {20, 16, 17, 18, 9.2, 7.8};
const std::string kColourFrame = "color_frame", kDepthFrame = "depth_frame";
constexpr const char* kColour = "/camera/color/image_raw";
constexpr const char* kDepth = "/camera/depth/image_rect_raw";

cv::Mat slanted_depth() {
  cv::Mat depth(16, 20, CV_16UC1);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 20; ++x) depth.at<uint16_t>(y, x) = static_cast<uint16_t>(1000 + 20 * x + 5 * y);
  return depth;
}

/// One frame whose depth has another camera, by RealSense's names; with what tells where that is.
std::vector<WrittenMessage> unaligned_messages(const std::vector<WrittenMessage>& geometry,
                                               bool infos = true) {
  std::vector<WrittenMessage> messages = geometry;
  if (infos) {
    messages.push_back(
        camera_message({"/camera/color/camera_info", kColourFrame, 1}, kLogCamera, {}, Wire::Cdr));
    messages.push_back(
        camera_message({"/camera/depth/camera_info", kDepthFrame, 1}, kDepthCamera, {}, Wire::Cdr));
  }
  messages.push_back(image_message({kColour, kColourFrame, kLogStart}, random_colour(0), "rgb8", Wire::Cdr));
  messages.push_back(image_message({kDepth, kDepthFrame, kLogStart}, slanted_depth(), "16UC1", Wire::Cdr));
  return messages;
}

/// What depth should become with the colour camera 3 cm to the right of the depth camera.
cv::Mat expected_depth() {
  DepthRegistration cameras{kDepthCamera, kLogCamera, Eigen::Isometry3d::Identity()};
  cameras.depth_to_colour.translation().x() = -0.03;
  return register_depth(depth_in_metres(slanted_depth(), {0.001}), cameras);
}

void check_registered(const std::filesystem::path& log, const DatasetOptions& options = {}) {
  const Dataset opened = open_dataset(log, options);
  const LoadedFrame loaded = opened.recording->load(0);
  REQUIRE_MESSAGE(loaded.frame, loaded.problem);
  CHECK(loaded.frame->depth.size() == cv::Size(32, 24));
  CHECK(cv::countNonZero(loaded.frame->depth) > 500);
  CHECK(cv::norm(loaded.frame->depth, expected_depth(), cv::NORM_INF) < 1e-6);
}

/// tf_static from both cameras to a frame of the device.
WrittenMessage static_frames() {
  return transform_message(
      "/tf_static", 1,
      {{"camera_link", kDepthFrame, {0, 0.1, 0}}, {"camera_link", kColourFrame, {0.03, 0.1, 0}}}, Wire::Cdr);
}

constexpr const char* kBothCameras =
    "width: 32\nheight: 24\nfx: 30\nfy: 31\ncx: 15.5\ncy: 11.5\ndepth_unit: 0.001\ndepth:\n  width: 20\n  "
    "height: 16\n"
    "  fx: 17\n  fy: 18\n  cx: 9.2\n  cy: 7.8\n  depth_to_colour: [1, 0, 0, -0.03, 0, 1, 0, 0, 0, 0, 1, 0, "
    "0, 0, 0, 1]\n";

}  // namespace

TEST_CASE("depth of another camera is registered by tf_static, by extrinsics, or as the SDK has it") {
  const TemporaryFolder logs;
  check_registered(logs.write("a.mcap", mcap_of(unaligned_messages({static_frames()}))));
  const auto extrinsics = message("/camera/extrinsics/depth_to_color", "realsense2_camera_msgs/Extrinsics", 1,
                                  Wire::Cdr, [](MessageWriter& writer) {
                                    writer.doubles({1, 0, 0, 0, 1, 0, 0, 0, 1}).doubles({-0.03, 0, 0});
                                  });
  check_registered(logs.write("a.mcap", mcap_of(unaligned_messages({extrinsics}))));
  std::vector<WrittenMessage> sdk;
  for (WrittenMessage message : unaligned_messages({})) {
    const bool depth = contains(message.topic, "depth");
    const bool info = contains(message.topic, "camera_info");
    message.topic = std::string(depth ? "/device_0/sensor_0/Depth_0" : "/device_0/sensor_1/Color_0") +
                    (info ? "/info/camera_info" : "/image/data");
    sdk.push_back(message);
  }
  for (const bool depth : {true, false}) {
    const std::string stream = depth ? "/device_0/sensor_0/Depth_0" : "/device_0/sensor_1/Color_0";
    sdk.push_back(
        message(stream + "/tf/0", "geometry_msgs/Transform", 1, Wire::Cdr, [&](MessageWriter& writer) {
          writer.doubles({depth ? 0.01 : -0.02, 0, 0, 0, 0, 0, 1});
        }));
  }
  check_registered(logs.write("a.mcap", mcap_of(sdk)));
  sdk.push_back(message("/device_0/sensor_0/option/Depth Units/value", "std_msgs/Float32", 1, Wire::Cdr,
                        [](MessageWriter& writer) { writer.number(0.0005f); }));
  CHECK(open_dataset(logs.write("a.mcap", mcap_of(sdk))).recording->depth_unit() == doctest::Approx(0.0005));
}

TEST_CASE("what is missing is asked for, and a camera.yaml gives it") {
  const TemporaryFolder logs;
  const auto file = logs.write("a.mcap", mcap_of(unaligned_messages({})));
  const std::string no_transform = input_error([&] { open_dataset(file); });
  CHECK(contains(no_transform, "not registered to the colour images of /camera/color/image_raw"));
  CHECK(contains(no_transform, "the log has no transform"));
  CHECK(contains(no_transform, "section depth"));
  const auto bare = logs.write("bare.mcap", mcap_of(unaligned_messages({}, false)));
  CHECK(contains(input_error([&] { open_dataset(bare); }), "there is no /camera/color/camera_info"));
  CHECK(contains(input_error([&] { open_dataset(bare, {.camera = "freiburg1"}); }), "needs a section depth"));
  const auto camera = logs.write("cameras.yaml", kBothCameras);
  check_registered(bare, {.camera = camera.string()});
  logs.write("camera.yaml", kBothCameras);
  check_registered(bare);
  CHECK(contains(joined(open_dataset(bare).recording->assumptions()), "camera.yaml"));
}

TEST_CASE("a section depth of camera.yaml registers the depth of a folder, and is checked") {
  const TemporaryFolder folder;
  write_png(folder.write("colour/0.png", ""), random_colour(0));
  write_png(folder.write("depth/0.png", ""), slanted_depth());
  folder.write("camera.yaml", kBothCameras);
  check_registered(folder.path());
  std::string text = kBothCameras;
  const auto error_of = [&](const std::string& part, const std::string& other) {
    std::string changed = text;
    changed.replace(changed.find(part), part.size(), other);
    folder.write("camera.yaml", changed);
    return input_error([&] { open_dataset(folder.path()); });
  };
  CHECK(contains(error_of("  fx: 17\n", ""), "depth.fx is missing"));
  CHECK(contains(error_of("[1, 0, 0, -0.03", "[2, 0, 0, -0.03"), "rigid 4 x 4 matrix"));
  CHECK(contains(error_of("width: 32\nheight: 24\n", ""), "width and height are missing"));
}

TEST_CASE(
    "depth in the frame of colour is registered; a smaller image of it is brought to the size of colour") {
  const TemporaryFolder logs;
  std::vector<WrittenMessage> messages;
  const Intrinsics half = kLogCamera.scaled(0.5);
  messages.push_back(
      camera_message({"/camera/color/camera_info", kColourFrame, 1}, kLogCamera, {}, Wire::Cdr));
  messages.push_back(camera_message({"/camera/depth/camera_info", kColourFrame, 1}, half, {}, Wire::Cdr));
  messages.push_back(image_message({kColour, kColourFrame, kLogStart}, random_colour(0), "rgb8", Wire::Cdr));
  messages.push_back(image_message({kDepth, kColourFrame, kLogStart},
                                   cv::Mat(12, 16, CV_16UC1, cv::Scalar(1500)), "16UC1", Wire::Cdr));
  const Dataset opened = open_dataset(logs.write("a.mcap", mcap_of(messages)));
  const LoadedFrame loaded = opened.recording->load(0);
  REQUIRE_MESSAGE(loaded.frame, loaded.problem);
  CHECK(cv::norm(loaded.frame->depth, cv::Mat(24, 32, CV_32FC1, cv::Scalar(1.5)), cv::NORM_INF) < 1e-6);
}

TEST_CASE("lenses: fisheye, rectified images, and models that nobody knows") {
  const auto intrinsics_of = [](const std::string& colour_topic, const std::vector<double>& distortion,
                                const std::string& model, std::string& warnings) {
    const TemporaryFolder logs;
    const std::string info = colour_topic.substr(0, colour_topic.find_last_of('/')) + "/camera_info";
    const Dataset opened = open_dataset(logs.write(
        "a.mcap",
        mcap_of({camera_message({info, kColourFrame, 1}, kLogCamera, distortion, Wire::Cdr, model),
                 image_message({colour_topic, kColourFrame, kLogStart}, random_colour(0), "rgb8", Wire::Cdr),
                 image_message({kDepth, kColourFrame, kLogStart}, random_depth(0), "16UC1", Wire::Cdr)})));
    warnings = joined(opened.recording->warnings());
    return opened.recording->load(0).frame->colour;
  };
  std::string warnings;
  const cv::Mat straight = random_colour(0);
  const auto differs = [&](const cv::Mat& image) { return cv::norm(image, straight, cv::NORM_INF) > 0; };
  CHECK(differs(intrinsics_of(kColour, {0.1, 0, 0, 0, 0}, "plumb_bob", warnings)));
  CHECK(differs(intrinsics_of(kColour, {0.1, 0, 0, 0, 0, 0.4, 0, 0}, "rational_polynomial", warnings)));
  CHECK(differs(intrinsics_of(kColour, {0.1, 0, 0, 0}, "equidistant", warnings)));
  CHECK(warnings.empty());
  CHECK_FALSE(
      differs(intrinsics_of("/camera/color/image_rect_color", {0.1, 0, 0, 0, 0}, "plumb_bob", warnings)));
  CHECK(warnings.empty());
  CHECK_FALSE(differs(intrinsics_of(kColour, {0.1, 0, 0, 0, 0}, "Inverse Brown Conrady", warnings)));
  CHECK(contains(warnings, "is not known and not corrected"));
  CHECK_FALSE(differs(intrinsics_of(kColour, {0, 0, 0, 0, 0}, "Inverse Brown Conrady", warnings)));
  CHECK(warnings.empty());
}

TEST_CASE("true poses come from tf, where one link moves above the camera, through those that do not") {
  const TemporaryFolder logs;
  std::vector<WrittenMessage> messages = unaligned_messages({static_frames()});
  for (int i = 0; i < 4; ++i)
    messages.push_back(transform_message(
        "/tf", kLogStart + i * kFrameTime,
        {{"/world", "/kinect", {0.1 * i, 0, 1}}, {"/kinect", "camera_link", {0, 0, 0.5}}}, Wire::Cdr));
  const Dataset opened = open_dataset(logs.write("a.mcap", mcap_of(messages)));
  REQUIRE(opened.truth());
  REQUIRE(opened.truth()->size() == 4);
  CHECK(opened.truth()->at(2).camera_to_world.translation().isApprox(Eigen::Vector3d(0.2, 0, 1)));
  // From the colour camera to /kinect: 3 cm and 10 cm to camera_link, and 50 cm on.
  CHECK(opened.recording->tracked_to_reference().translation().isApprox(Eigen::Vector3d(0.03, 0.1, 0.5)));
  CHECK(contains(joined(opened.recording->assumptions()), "those of kinect in world"));
}

TEST_CASE("odometry is the truth of its frame where nothing is named for truth") {
  const TemporaryFolder logs;
  std::vector<WrittenMessage> messages = unaligned_messages({static_frames()});
  for (int i = 0; i < 3; ++i)
    messages.push_back(message("/odom", "nav_msgs/Odometry", kLogStart + i * kFrameTime, Wire::Cdr,
                               [&](MessageWriter& writer) {
                                 writer.header(kLogStart + i * kFrameTime, "odom").text("camera_link");
                                 writer.doubles({1.0 * i, 0, 0, 0, 0, 0, 1});
                               }));
  const Dataset opened = open_dataset(logs.write("a.mcap", mcap_of(messages)));
  REQUIRE(opened.truth());
  CHECK(opened.truth()->size() == 3);
  CHECK(opened.recording->tracked_to_reference().translation().isApprox(Eigen::Vector3d(0.03, 0.1, 0)));
}
