// The encodings of images in messages.
#include "engine/sources/log_images.h"

#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "engine/io/images.h"
#include "tests/sources/log_scene.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// The colour of a message whose pixels all have these bytes.
cv::Vec3b colour_of_even(const std::string& encoding, const cv::Mat& image) {
  const WrittenMessage written = image_message({"/a", "f", 1}, image, encoding, Wire::Cdr);
  const cv::Mat colour = colour_of(read_image({written.bytes, Serialisation::Cdr, "log"}), "log");
  CHECK(colour.type() == CV_8UC3);
  CHECK(colour.size() == image.size());
  return colour.at<cv::Vec3b>(4, 4);
}

/// An image of a Bayer pattern that shows only red: `first` is the place of red in the first two rows.
cv::Mat only_red(cv::Point first) {
  cv::Mat mosaic(8, 8, CV_8UC1, cv::Scalar(0));
  for (int y = first.y; y < 8; y += 2)
    for (int x = first.x; x < 8; x += 2) mosaic.at<uint8_t>(y, x) = 200;
  return mosaic;
}

cv::Mat depth_of_bytes(const std::string& format, const std::string& data, double unit = 0.001) {
  CompressedImageMessage image;
  image.format = format;
  image.data = data;
  return depth_of(image, unit, "log");
}

std::string depth_head(float a, float b) {
  std::string head(4, '\0');
  head.append(reinterpret_cast<const char*>(&a), 4);
  head.append(reinterpret_cast<const char*>(&b), 4);
  return head;
}

/// Packs by the description of RVL.
std::string rvl_of(const cv::Mat& depth) {
  std::vector<uint32_t> words;
  int groups = 0;
  const auto put = [&](uint32_t value) {
    do {
      const uint32_t group = (value & 7u) | (value > 7 ? 8u : 0u);
      if (groups % 8 == 0) words.push_back(0);
      words.back() |= group << (28 - 4 * (groups % 8));
      ++groups;
      value >>= 3;
    } while (value > 0);
  };
  const auto* pixels = reinterpret_cast<const uint16_t*>(depth.data);
  std::size_t at = 0;
  int last = 0;
  while (at < depth.total()) {
    std::size_t zeros = 0, others = 0;
    while (at + zeros < depth.total() && pixels[at + zeros] == 0) ++zeros;
    at += zeros;
    while (at + others < depth.total() && pixels[at + others] != 0) ++others;
    put(static_cast<uint32_t>(zeros));
    put(static_cast<uint32_t>(others));
    for (std::size_t i = 0; i < others; ++i, ++at) {
      const int step = pixels[at] - last;
      put(static_cast<uint32_t>(step >= 0 ? 2 * step : -2 * step - 1));
      last = pixels[at];
    }
  }
  const int32_t size[2] = {depth.cols, depth.rows};
  return std::string(reinterpret_cast<const char*>(size), 8) +
         std::string(reinterpret_cast<const char*>(words.data()), 4 * words.size());
}

}  // namespace

TEST_CASE("colours of all encodings become RGB") {
  const cv::Size size(8, 8);
  const cv::Vec3b expected(10, 100, 200);
  CHECK(colour_of_even("rgb8", cv::Mat(size, CV_8UC3, cv::Scalar(10, 100, 200))) == expected);
  CHECK(colour_of_even("bgr8", cv::Mat(size, CV_8UC3, cv::Scalar(200, 100, 10))) == expected);
  CHECK(colour_of_even("rgba8", cv::Mat(size, CV_8UC4, cv::Scalar(10, 100, 200, 7))) == expected);
  CHECK(colour_of_even("bgra8", cv::Mat(size, CV_8UC4, cv::Scalar(200, 100, 10, 7))) == expected);
  CHECK(colour_of_even("mono8", cv::Mat(size, CV_8UC1, cv::Scalar(77))) == cv::Vec3b(77, 77, 77));
  // Y 82, U 90, V 240 is nearly pure red; yuv422 begins with U.
  cv::Mat uyvy(size, CV_8UC2), yuyv(size, CV_8UC2);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const auto chroma = static_cast<uint8_t>(x % 2 == 0 ? 90 : 240);
      uyvy.at<cv::Vec2b>(y, x) = {chroma, 82};
      yuyv.at<cv::Vec2b>(y, x) = {82, chroma};
    }
  }
  for (const auto& [encoding, image] : {std::pair{"yuv422", uyvy}, {"yuv422_yuy2", yuyv}, {"YUYV", yuyv}}) {
    const cv::Vec3b red = colour_of_even(encoding, image);
    CHECK(red[0] > 240);
    CHECK(red[1] < 15);
    CHECK(red[2] < 15);
  }
  const std::pair<const char*, cv::Point> patterns[] = {
      {"bayer_rggb8", {0, 0}}, {"bayer_bggr8", {1, 1}}, {"bayer_gbrg8", {0, 1}}, {"bayer_grbg8", {1, 0}}};
  for (const auto& pattern : patterns) {
    CAPTURE(pattern.first);
    CHECK(colour_of_even(pattern.first, only_red(pattern.second)) == cv::Vec3b(200, 0, 0));
  }
}

TEST_CASE("depth in millimetres and in metres, in either byte order, with rows of any length") {
  MessageWriter writer(Wire::Cdr);
  writer.header(1, "f").number(uint32_t{2}).number(uint32_t{1}).text("mono16").number(uint8_t{1});
  writer.number(uint32_t{5}).data(std::string_view("\x04\xd2xxx\x00\x00", 7));  // 1234, then nothing
  const cv::Mat depth = depth_of(read_image({writer.bytes(), Serialisation::Cdr, "log"}), 0.001, "log");
  CHECK(depth.at<float>(0, 0) == 1.234f);
  CHECK(depth.at<float>(1, 0) == 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat metres = (cv::Mat_<float>(1, 4) << 1.5f, nan, -1, std::numeric_limits<float>::infinity());
  const WrittenMessage written = image_message({"/d", "f", 1}, metres, "32FC1", Wire::Ros1);
  const cv::Mat read = depth_of(read_image({written.bytes, Serialisation::Ros1, "log"}), 0.001, "log");
  CHECK(cv::norm(read, cv::Mat((cv::Mat_<float>(1, 4) << 1.5f, 0, 0, 0)), cv::NORM_INF) == 0);
}

TEST_CASE("compressedDepth: steps, numbers that stand for 1 / depth, and RVL") {
  const cv::Mat steps = random_depth(3);
  std::vector<uchar> png;
  cv::imencode(".png", steps, png);
  const std::string bytes(png.begin(), png.end());
  const cv::Mat expected = depth_in_metres(steps, {0.001});
  CHECK(cv::norm(depth_of_bytes("16UC1; compressedDepth png", depth_head(0, 0) + bytes), expected,
                 cv::NORM_INF) == 0);
  CHECK(cv::norm(depth_of_bytes("16UC1; png compressed", bytes), expected, cv::NORM_INF) == 0);
  CHECK(cv::norm(depth_of_bytes("16UC1; compressedDepth rvl", depth_head(0, 0) + rvl_of(steps)), expected,
                 cv::NORM_INF) == 0);
  const cv::Mat inverse = depth_of_bytes("32FC1; compressedDepth png", depth_head(1000, -100) + bytes);
  for (int x = 0; x < 32; ++x) {
    const double step = steps.at<uint16_t>(7, x);
    CHECK(inverse.at<float>(7, x) == doctest::Approx(step == 0 ? 0 : 1000 / (step + 100)));
  }
  CHECK(contains(input_error([&] { depth_of_bytes("16UC1; compressedDepth rvl", "0123456789ab"); }),
                 "has no size"));
  const std::string cut = depth_head(0, 0) + rvl_of(steps).substr(0, 200);
  CHECK(!input_error([&] { depth_of_bytes("16UC1; compressedDepth rvl", cut); }).empty());
}

TEST_CASE("images that lie about their size are refused before anything is taken for them") {
  ImageMessage image;
  image.encoding = "rgb8";
  image.width = image.height = 60000;
  image.step = 180000;
  image.data = "few bytes";
  CHECK(contains(input_error([&] { colour_of(image, "log"); }), "too few bytes"));
  image.width = 0;
  CHECK(contains(input_error([&] { colour_of(image, "log"); }), "has no size"));
  image.width = 3000000000;
  CHECK(contains(input_error([&] { colour_of(image, "log"); }), "too large"));
  image.encoding = "rgb16";
  image.width = 1;
  CHECK(contains(input_error([&] { colour_of(image, "log"); }), "\"rgb16\" is none of colour"));
}
