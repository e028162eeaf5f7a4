// Messages in both serialisations, and in both byte orders of CDR.
#include "engine/logs/messages.h"

#include <cmath>

#include "tests/support/input_files.h"
#include "tests/support/log_writers.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr int64_t kStamp = 1305031102175304123;

/// Message of each serialisation, given to `check`.
template <typename Write, typename Check>
void for_each_wire(Write write, Check check) {
  for (const Wire wire : {Wire::Ros1, Wire::Cdr, Wire::CdrBigEndian}) {
    CAPTURE(static_cast<int>(wire));
    MessageWriter writer(wire);
    write(writer);
    const Serialisation serialisation = wire == Wire::Ros1 ? Serialisation::Ros1 : Serialisation::Cdr;
    check(SerialisedMessage{writer.bytes(), serialisation, "log"});
    // Cut anywhere it is refused.
    for (std::size_t length = 0; length < writer.bytes().size(); length += 3) {
      const std::string cut = writer.bytes().substr(0, length);
      CHECK(!input_error([&] { check(SerialisedMessage{cut, serialisation, "log"}); }).empty());
    }
  }
}

const std::vector<double> kPlace = {1, 2, 3};
const std::vector<double> kTurn = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // 90 degrees about z

void check_pose(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d moved = pose * Eigen::Vector3d(1, 0, 0);
  CHECK(moved.isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
}

}  // namespace

TEST_CASE("an image") {
  for_each_wire(
      [](MessageWriter& writer) {
        writer.header(kStamp, "camera").number(uint32_t{3}).number(uint32_t{2}).text("bgr8");
        writer.number(uint8_t{1}).number(uint32_t{6}).data("abcdefghijklmnopqr");
      },
      [](const SerialisedMessage& message) {
        const ImageMessage image = read_image(message);
        CHECK(image.header.stamp == 1305031102.175304123);
        CHECK(image.header.frame == "camera");
        CHECK(image.height == 3);
        CHECK(image.width == 2);
        CHECK(image.encoding == "bgr8");
        CHECK(image.big_endian);
        CHECK(image.step == 6);
        CHECK(image.data == "abcdefghijklmnopqr");
      });
}

TEST_CASE("a camera, whose matrices follow a list of any length") {
  for (const std::vector<double>& distortion : {std::vector<double>{}, {1, 2, 3, 4, 5}}) {
    for_each_wire(
        [&](MessageWriter& writer) {
          writer.header(kStamp, "c").number(uint32_t{480}).number(uint32_t{640}).text("plumb_bob");
          writer.number(static_cast<uint32_t>(distortion.size())).doubles(distortion);
          writer.doubles({500, 0, 320, 0, 510, 240, 0, 0, 1}).doubles(std::vector<double>(9, 7));
          writer.doubles({400, 0, 300, 0, 0, 410, 200, 0, 0, 0, 1, 0});
        },
        [&](const SerialisedMessage& message) {
          const CameraInfoMessage camera = read_camera_info(message);
          CHECK(camera.width == 640);
          CHECK(camera.model == "plumb_bob");
          CHECK(camera.distortion == distortion);
          CHECK(camera.intrinsics[4] == 510);
          CHECK(camera.projection[0] == 400);
          CHECK(camera.projection[6] == 200);
        });
  }
}

TEST_CASE("transforms, poses and odometry") {
  for_each_wire(
      [](MessageWriter& writer) {
        writer.number(uint32_t{2});
        for (const char* child : {"a", "bc"})
          writer.header(kStamp, "world").text(child).doubles(kPlace).doubles(kTurn);
      },
      [](const SerialisedMessage& message) {
        const auto transforms = read_transforms(message);
        REQUIRE(transforms.size() == 2);
        CHECK(transforms[1].header.frame == "world");
        CHECK(transforms[1].child == "bc");
        check_pose(transforms[1].child_to_parent);
      });
  for_each_wire([](MessageWriter& writer) { writer.header(kStamp, "map").doubles(kPlace).doubles(kTurn); },
                [](const SerialisedMessage& message) { check_pose(read_pose(message).child_to_parent); });
  for_each_wire(
      [](MessageWriter& writer) {
        writer.header(kStamp, "odom").text("base").doubles(kPlace).doubles(kTurn);
      },
      [](const SerialisedMessage& message) {
        const TransformMessage odometry = read_odometry(message);
        CHECK(odometry.child == "base");
        check_pose(odometry.child_to_parent);
      });
}

TEST_CASE("a quaternion without direction is a pose that is not known") {
  MessageWriter writer(Wire::Cdr);
  writer.header(kStamp, "map").doubles(kPlace).doubles({0, 0, 0, 0});
  const TransformMessage pose = read_pose({writer.bytes(), Serialisation::Cdr, "log"});
  CHECK_FALSE(pose.child_to_parent.matrix().allFinite());
}

TEST_CASE("RealSense's extrinsics, whose rotation stands column by column, with and without a header") {
  for (const bool header : {false, true}) {
    MessageWriter writer(Wire::Ros1);
    if (header) writer.header(kStamp, "");
    writer.doubles({0, 1, 0, -1, 0, 0, 0, 0, 1}).doubles(kPlace);
    check_pose(read_extrinsics({writer.bytes(), Serialisation::Ros1, "log"}));
  }
}

TEST_CASE("what is no CDR, or another encoding, is refused") {
  const std::string bytes("\7\7\0\0abcdefgh", 12);
  CHECK(contains(input_error([&] {
                   read_message_header({bytes, Serialisation::Cdr, "log"});
                 }),
                 "does not begin as CDR"));
  CHECK(contains(input_error([&] {
                   read_message_header({bytes, Serialisation::Other, "log"});
                 }),
                 "serialised in a way that is not read"));
  MessageWriter writer(Wire::Cdr);
  writer.number(uint32_t{0xffffffff});
  CHECK(!input_error([&] { read_transforms({writer.bytes(), Serialisation::Cdr, "log"}); }).empty());
}
