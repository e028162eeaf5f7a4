#include "engine/io/images.h"

#include <cstring>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "engine/io/camera_json.h"
#include "engine/io/files.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

/// Values that a careless path would change: negative, tiny, huge, infinite, NaN.
cv::Mat difficult_image(int type) {
  cv::Mat image(5, 7, type);
  auto* values = image.ptr<float>();
  const std::size_t count = image.total() * static_cast<std::size_t>(image.channels());
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i) * -0.37f + 1;
  values[0] = std::numeric_limits<float>::quiet_NaN();
  values[1] = -std::numeric_limits<float>::infinity();
  values[2] = std::numeric_limits<float>::denorm_min();
  values[3] = std::numeric_limits<float>::max();
  values[4] = -0.0f;
  return image;
}

bool same_bits(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && a.isContinuous() && b.isContinuous() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

constexpr const char* kCamera = R"({"width": 64, "height": 48, "fx": 50, "fy": 51, "cx": 31.5, "cy": 23.5,
  "world_to_camera": [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]})";

}  // namespace

TEST_CASE("float TIFFs keep every bit, with 1 and 3 channels") {
  const TemporaryFolder folder;
  for (int type : {CV_32FC1, CV_32FC3}) {
    const cv::Mat image = difficult_image(type);
    write_tiff(folder / "a.tiff", image);
    CHECK(same_bits(read_tiff(folder / "a.tiff"), image));
  }
}

TEST_CASE("TIFF colours are stored as RGB and uncompressed") {
  const TemporaryFolder folder;
  write_tiff(folder / "a.tiff", cv::Mat(20, 30, CV_32FC3, cv::Scalar(0.25, 0.5, 0.75)));
  const cv::Mat bgr = cv::imread((folder / "a.tiff").string(), cv::IMREAD_UNCHANGED);
  CHECK(bgr.at<cv::Vec3f>(0, 0) == cv::Vec3f(0.75f, 0.5f, 0.25f));
  CHECK(std::filesystem::file_size(folder / "a.tiff") >= 20 * 30 * 12);
}

TEST_CASE("PNGs: RGB order, 16 bits, floats clamped and rounded") {
  const TemporaryFolder folder;
  cv::Mat colour(2, 2, CV_8UC3, cv::Scalar(1, 2, 3));
  write_png(folder / "a.png", colour);
  CHECK(same_bits(read_colour(folder / "a.png"), colour));
  cv::Mat depth(2, 2, CV_16UC1, cv::Scalar(40000));
  write_png(folder / "a.png", depth);
  CHECK(same_bits(cv::imread((folder / "a.png").string(), cv::IMREAD_UNCHANGED), depth));
  cv::Mat grey(1, 6, CV_32FC1);
  const float infinity = std::numeric_limits<float>::infinity();
  const float values[6] = {-1, 0.5f, 1, 3e9f, infinity, std::numeric_limits<float>::quiet_NaN()};
  std::memcpy(grey.data, values, sizeof(values));
  write_png(folder / "a.png", grey);
  const cv::Mat read = cv::imread((folder / "a.png").string(), cv::IMREAD_UNCHANGED);
  const std::vector<int> expected = {0, 128, 255, 255, 255, 0};
  for (int x = 0; x < 6; ++x) CHECK(read.at<uchar>(0, x) == expected[static_cast<std::size_t>(x)]);
}

TEST_CASE("images of wrong types and damaged files are refused") {
  const TemporaryFolder folder;
  CHECK(contains(input_error([&] { write_tiff(folder / "a.tiff", cv::Mat(2, 2, CV_8UC1)); }),
                 "a.tiff: only 32-bit"));
  CHECK(contains(input_error([&] { write_png(folder / "a.png", cv::Mat(2, 2, CV_64FC1)); }),
                 "cannot be written"));
  CHECK(contains(input_error([&] { write_png(folder / "no/a.png", cv::Mat(2, 2, CV_8UC1)); }),
                 "create it first"));
  write_png(folder / "a.png", cv::Mat(2, 2, CV_8UC1));
  CHECK(contains(input_error([&] { read_tiff(folder / "a.png"); }), "is no 32-bit float image"));
  CHECK(contains(input_error([&] { read_depth(folder / "a.png", {}); }), "is no depth image"));
  CHECK(contains(input_error([&] { read_colour(folder.path()); }), "is a folder"));
}

TEST_CASE("depth is scaled to metres") {
  const TemporaryFolder folder;
  cv::Mat stored(1, 3, CV_16UC1);
  stored.at<uint16_t>(0, 0) = 0;
  stored.at<uint16_t>(0, 1) = 5000;
  stored.at<uint16_t>(0, 2) = 65535;
  write_png(folder / "d.png", stored);
  const cv::Mat depth = read_depth(folder / "d.png", {1.0 / 5000, 65535});
  CHECK(depth.at<float>(0, 0) == 0);
  CHECK(depth.at<float>(0, 1) == 1.0f);
  CHECK(depth.at<float>(0, 2) == 0);
  CHECK(read_depth(folder / "d.png", {1.0 / 5000, 0}).at<float>(0, 2) == 13.107f);
}

TEST_CASE("a colour PNG cut at any byte but its last chunk is refused") {
  const TemporaryFolder folder;
  cv::Mat colour(9, 9, CV_8UC3);
  cv::randu(colour, 0, 255);
  write_png(folder / "a.png", colour);
  const std::string full = read_file(folder / "a.png");
  constexpr std::size_t kEndChunk = 12;
  for (std::size_t length = 0; length < full.size() - kEndChunk - 8; length += 3) {
    const auto file = folder.write("cut.png", full.substr(0, length));
    CHECK(contains(input_error([&] { read_colour(file); }), "cut.png: is not a readable image"));
  }
}

TEST_CASE("a camera is read from JSON") {
  const TemporaryFolder folder;
  const Camera camera = read_camera(folder.write("camera.json", kCamera));
  CHECK(camera.intrinsics.width == 64);
  CHECK(camera.intrinsics.fy == 51);
  CHECK((camera.world_to_camera * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm() < 1e-12);
}

TEST_CASE("a camera that was written is read as it was") {
  const TemporaryFolder folder;
  Camera camera{{.width = 31, .height = 17, .fx = 20.1, .fy = 1.0 / 3, .cx = 15, .cy = -2e-7}};
  camera.world_to_camera = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, -2, 3).normalized()) *
                           Eigen::Translation3d(0.1, 1.0 / 7, -3e-9);
  write_camera(folder / "camera.json", camera);
  const Camera same = read_camera(folder / "camera.json");
  CHECK(same.intrinsics.width == 31);
  CHECK(same.intrinsics.fy == camera.intrinsics.fy);
  CHECK(same.intrinsics.cy == camera.intrinsics.cy);
  CHECK(same.world_to_camera.isApprox(camera.world_to_camera, 1e-14));
}

TEST_CASE("each wrong key of a camera is named") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string text = kCamera;
    text.replace(text.find(from), from.size(), to);
    return input_error([&] { read_camera(folder.write("camera.json", text)); });
  };
  CHECK(contains(error("\"fx\": 50", "\"fx\": 0"), "camera.json: \"fx\" must be greater than 0"));
  CHECK(contains(error("\"fx\": 50", "\"fx\": \"50\""), "\"fx\" must be a number"));
  CHECK(contains(error("\"cy\"", "\"other\""), "\"cy\" is missing"));
  CHECK(contains(error("64", "-64"), "\"width\" must be greater than 0"));
  CHECK(contains(error("64", "1e99"), "\"width\" must be a whole number of pixels"));
  CHECK(contains(error("[0, -1, 0, 1]", "[0, -1.1, 0, 1]"), "\"world_to_camera\" must be a rotation"));
  CHECK(contains(error("[0, -1, 0, 1]", "[0, 1, 0, 1]"), "must be a rotation"));  // a mirror
  CHECK(contains(error("[0, -1, 0, 1]", "[0, -1, 1]"), "must be four rows of four numbers"));
  CHECK(contains(error("[0, 0, 0, 1]]", "[0, 0, 0, 2]]"), "must be a rotation"));
  CHECK(contains(error("[0, -1, 0, 1]", "[0, \"x\", 0, 1]"), "must hold numbers only"));
  CHECK(contains(error("[[0, -1, 0, 1], ", "["), "must be a rotation"));
}
