// ScanNet's container, written here from its description.
#include <fmt/format.h>
#include <zlib.h>

#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "engine/sources/open_dataset.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

struct SensOptions {
  uint32_t version = 4;
  int32_t colour = 2;  ///< jpeg
  int32_t depth = 1;   ///< zlib
  int frames = 3;
};

template <typename T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void append_matrix(std::string& bytes, const std::array<float, 16>& matrix) {
  for (float value : matrix) append(bytes, value);
}

constexpr std::array<float, 16> kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

std::string colour_bytes(int32_t compression) {
  const cv::Mat image(60, 80, CV_8UC3,
                      compression == 0 ? cv::Scalar(200, 100, 10) : cv::Scalar(10, 100, 200));
  if (compression == 0) return {reinterpret_cast<const char*>(image.data), image.total() * 3};
  std::vector<uchar> bytes;
  cv::imencode(compression == 1 ? ".png" : ".jpg", image, bytes);
  return {bytes.begin(), bytes.end()};
}

std::string depth_bytes(int32_t compression, int frame) {
  const std::vector<uint16_t> steps(40 * 30, static_cast<uint16_t>(2000 + frame));
  const std::string raw(reinterpret_cast<const char*>(steps.data()), 2 * steps.size());
  if (compression == 0) return raw;
  std::string packed(compressBound(static_cast<uLong>(raw.size())), '\0');
  auto size = static_cast<uLongf>(packed.size());
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
           static_cast<uLong>(raw.size()));
  packed.resize(size);
  return packed;
}

std::string sens(const SensOptions& options) {
  std::string bytes;
  append(bytes, options.version);
  const std::string sensor = "StructureSensor";
  append(bytes, static_cast<uint64_t>(sensor.size()));
  bytes += sensor;
  append_matrix(bytes, {72, 0, 39.5f, 0, 0, 74, 29.5f, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  append_matrix(bytes, kIdentity);
  append_matrix(bytes, {36, 0, 19.5f, 0, 0, 37, 14.5f, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  append_matrix(bytes, kIdentity);
  append(bytes, options.colour);
  append(bytes, options.depth);
  for (uint32_t side : {80u, 60u, 40u, 30u}) append(bytes, side);
  append(bytes, 1000.0f);
  append(bytes, static_cast<uint64_t>(options.frames));
  for (int i = 0; i < options.frames; ++i) {
    std::array<float, 16> pose = kIdentity;
    pose[3] = static_cast<float>(i);
    if (i == 1) pose.fill(-std::numeric_limits<float>::infinity());
    append_matrix(bytes, pose);
    const std::string colour = colour_bytes(options.colour), depth = depth_bytes(options.depth, i);
    for (std::size_t value : {std::size_t{7}, std::size_t{8}, colour.size(), depth.size()}) {
      append(bytes, static_cast<uint64_t>(value));
    }
    bytes += colour + depth;
  }
  return bytes;
}

std::string open_error(const std::filesystem::path& path) {
  return input_error([&] { open_dataset(path); });
}

}  // namespace

TEST_CASE("a .sens file is read, itself or by its folder, in every way of storing that is known") {
  for (int32_t colour : {0, 1, 2}) {
    for (int32_t depth : {0, 1}) {
      CAPTURE(colour);
      CAPTURE(depth);
      const TemporaryFolder folder;
      const auto file = folder.write("scene0000_00.sens", sens({.colour = colour, .depth = depth}));
      const auto dataset = open_dataset(colour == 2 ? file : folder.path());
      CHECK(dataset.recording->format() == "scannet");
      CHECK(dataset.recording->name() == "scene0000_00");
      CHECK(dataset.recording->warnings().empty());
      CHECK(dataset.recording->depth_unit() == doctest::Approx(0.001));
      REQUIRE(dataset.recording->count() == 3);
      CHECK(dataset.recording->intrinsics().width == 40);
      CHECK(dataset.recording->intrinsics().height == 30);
      CHECK(dataset.recording->intrinsics().fx == 36);
      CHECK(dataset.recording->intrinsics().cy == 14.5);
      CHECK_FALSE(dataset.ground_truth->at(1).is_finite());
      CHECK(dataset.ground_truth->at(2).camera_to_world.translation().x() == 2);
      const LoadedFrame loaded = dataset.recording->load(2);
      REQUIRE_MESSAGE(loaded.frame, loaded.problem);
      CHECK(loaded.frame->timestamp == 2);
      CHECK(loaded.frame->colour.size() == cv::Size(40, 30));
      const auto pixel = loaded.frame->colour.at<cv::Vec3b>(15, 20);
      CHECK(std::abs(pixel[0] - 200) <= 3);
      CHECK(std::abs(pixel[2] - 10) <= 3);
      CHECK(loaded.frame->depth.at<float>(29, 39) == doctest::Approx(2.002));
    }
  }
}

TEST_CASE("a .sens file that cannot be read says why") {
  const TemporaryFolder folder;
  CHECK(contains(open_error(folder.write("a.sens", sens({.version = 3}))), "no .sens file of version 4"));
  CHECK(contains(open_error(folder.write("a.sens", sens({.depth = 2}))), "occi_ushort"));
  CHECK(contains(open_error(folder.write("a.sens", sens({.colour = 9}))), "colour in an unknown way"));
  CHECK(contains(open_error(folder.write("a.sens", sens({}).substr(0, 100))), "ends too early"));
  CHECK(contains(open_error(folder.write("a.sens", sens({.frames = 0}))), "holds no complete frame"));
  folder.write("a.sens", sens({}));
  folder.write("b.sens", sens({}));
  CHECK(contains(open_error(folder.path()), "holds 2 .sens files"));
}

TEST_CASE("a .sens file that was cut off gives its complete frames, a damaged frame is one bad frame") {
  const TemporaryFolder folder;
  std::string bytes = sens({});
  const auto cut = open_dataset(folder.write("cut.sens", bytes.substr(0, bytes.size() - 5)));
  CHECK(cut.recording->count() == 2);
  REQUIRE(cut.recording->warnings().size() == 1);
  CHECK(contains(cut.recording->warnings().front(), "ends after 2 of 3 frames"));
  CHECK(cut.recording->load(1).frame);
  for (std::size_t i = bytes.size() - 8; i < bytes.size(); ++i) bytes[i] = '\0';
  const auto damaged = open_dataset(folder.write("damaged.sens", bytes));
  REQUIRE(damaged.recording->count() == 3);
  CHECK(damaged.recording->load(1).frame);
  CHECK(contains(damaged.recording->load(2).problem, "(frame 2): the depth image is damaged"));
}
