// Recordings written in other layouts, and read back.
#include "engine/sources/recording_writer.h"

#include <doctest/doctest.h>

#include <cstring>
#include <opencv2/imgproc.hpp>
#include <random>

#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

constexpr double kUnit = 0.0002;
const Intrinsics kCamera{40, 30, 41.25, 41.5, 19.625, 14.5};

/// Noise with holes; depth in steps of kUnit.
WrittenFrame some_frame(int i, double depth_after = 0) {
  std::mt19937 random(static_cast<uint32_t>(i + 1));
  Frame frame{.index = i, .timestamp = 1305031102.175304 + i / 30.0};
  frame.colour = cv::Mat(30, 40, CV_8UC3);
  frame.depth = cv::Mat(30, 40, CV_32FC1);
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 40; ++u) {
      frame.colour.at<cv::Vec3b>(v, u) = cv::Vec3b(
          static_cast<uint8_t>(random()), static_cast<uint8_t>(random()), static_cast<uint8_t>(random()));
      frame.depth.at<float>(v, u) =
          random() % 5 ? static_cast<float>(static_cast<double>(random() % 65536) * kUnit) : 0.0f;
    }
  return {frame, frame.timestamp + depth_after};
}

Trajectory some_truth() {
  Trajectory truth;
  for (int i = 0; i < 3; ++i) {
    StampedPose pose{.timestamp = some_frame(i).frame.timestamp};
    pose.camera_to_world.translation() = Eigen::Vector3d(0.25 * i, -1, 2);
    truth.push_back(pose);
  }
  return truth;
}

using Write = std::unique_ptr<RecordingWriter> (*)(const std::filesystem::path&, const WrittenRecording&);

bool same_bits(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

/// Writes three frames and reads them back.
void check_round_trip(Write write, const std::filesystem::path& path, double depth_after) {
  const auto writer = write(path, {.name = "three", .intrinsics = kCamera, .depth_unit = kUnit});
  for (int i = 0; i < 3; ++i) writer->write(some_frame(i, depth_after));
  writer->finish(some_truth());
  const Dataset dataset = open_dataset(path);
  const Recording& recording = *dataset.recording;
  REQUIRE(recording.count() == 3);
  const Intrinsics k = recording.intrinsics();
  CHECK(k.width == kCamera.width);
  CHECK(k.fx == kCamera.fx);
  CHECK(k.fy == kCamera.fy);
  CHECK(k.cx == kCamera.cx);
  CHECK(k.cy == kCamera.cy);
  for (int i = 0; i < 3; ++i) {
    const WrittenFrame before = some_frame(i, depth_after);
    const LoadedFrame after = recording.load(i);
    REQUIRE_MESSAGE(after.frame, after.problem);
    CHECK(same_bits(after.frame->colour, before.frame.colour));
    CHECK(same_bits(after.frame->depth, before.frame.depth));
    CHECK(recording.timestamp(i) == before.frame.timestamp);
    CHECK(recording.depth_timestamp(i) == before.depth_timestamp);
  }
  REQUIRE(dataset.ground_truth);
  REQUIRE(dataset.ground_truth->size() == 3);
  CHECK((*dataset.ground_truth)[2].camera_to_world.translation() == Eigen::Vector3d(0.5, -1, 2));
}

}  // namespace

TEST_CASE("a recording that is written in any layout has the same pixels, depths and stamps") {
  const TemporaryFolder folder;
  check_round_trip(write_tum, folder / "tum", 0.004);
  check_round_trip(write_plain, folder / "plain", 0);
  check_round_trip(write_mcap, folder / "log.mcap", 0.004);
  CHECK_FALSE(std::filesystem::exists(folder / "log.mcap.part"));
}

TEST_CASE("a log has room for any depth, and for more than one chunk") {
  const TemporaryFolder folder;
  WrittenFrame frame = some_frame(0);
  frame.frame.depth *= 1.0 / 3;
  frame.frame.colour = cv::Mat(1200, 1600, CV_8UC3, cv::Scalar(1, 2, 3));
  cv::resize(frame.frame.depth, frame.frame.depth, cv::Size(1600, 1200), 0, 0, cv::INTER_NEAREST);
  const auto writer = write_mcap(
      folder / "log.mcap", {.name = "", .intrinsics = {1600, 1200, 1700, 1700, 800, 600}, .depth_unit = 1});
  for (int i = 0; i < 3; ++i) {
    frame.frame.timestamp = frame.depth_timestamp = i;
    writer->write(frame);
  }
  writer->finish(std::nullopt);
  const Dataset dataset = open_dataset(folder / "log.mcap");
  REQUIRE(dataset.recording->count() == 3);
  CHECK(same_bits(dataset.recording->load(2).frame->depth, frame.frame.depth));
  CHECK(dataset.recording->warnings().empty());
  CHECK_FALSE(dataset.ground_truth);
}

TEST_CASE("what a layout cannot hold is refused, and rounded where that was asked for") {
  const TemporaryFolder folder;
  WrittenFrame frame = some_frame(0);
  frame.frame.depth.at<float>(0, 0) = 1.00013f;
  frame.frame.depth.at<float>(0, 1) = 20;
  WrittenRecording recording{.name = "", .intrinsics = kCamera, .depth_unit = kUnit};
  const auto error = [&](Write write, const char* name) {
    return input_error([&] { write(folder / name, recording)->write(frame); });
  };
  CHECK(contains(error(write_tum, "a"), "2 depths that are no steps of 0.0002 m"));
  CHECK_FALSE(std::filesystem::exists(folder / "a"));
  recording.lossy = true;
  const auto writer = write_plain(folder / "b", recording);
  frame.depth_timestamp += 0.01;
  writer->write(frame);
  writer->finish(std::nullopt);
  const cv::Mat depth = open_dataset(folder / "b").recording->load(0).frame->depth;
  CHECK(depth.at<float>(0, 0) == doctest::Approx(1.0002));
  CHECK(depth.at<float>(0, 1) == 0);  // too far for 16 bits
  recording.lossy = false;
  frame.frame = some_frame(0).frame;
  CHECK(contains(error(write_plain, "c"), "depth image of another time"));
}

TEST_CASE("nothing that is there is written over") {
  const TemporaryFolder folder;
  const WrittenRecording recording{.name = "", .intrinsics = kCamera, .depth_unit = kUnit};
  folder.write("full/thing.txt", "mine");
  folder.write("log.mcap", "mine");
  CHECK(contains(input_error([&] { write_tum(folder / "full", recording); }), "is not empty"));
  CHECK(contains(input_error([&] { write_mcap(folder / "log.mcap", recording); }), "is there already"));
  CHECK(contains(input_error([&] { write_mcap(folder / "no/such.mcap", recording); }), "cannot be written"));
  { const auto broken_off = write_mcap(folder / "half.mcap", recording); }
  CHECK_FALSE(std::filesystem::exists(folder / "half.mcap.part"));
  CHECK_FALSE(std::filesystem::exists(folder / "half.mcap"));
}
