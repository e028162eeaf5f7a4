#include "engine/io/encoded_image.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/io/images.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

cv::Mat noise(cv::Size size, int type = CV_8UC3) {
  cv::Mat image(size, type);
  cv::RNG(3).fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

std::string encoded(const char* extension, const cv::Mat& image, const std::vector<int>& options = {}) {
  std::vector<uchar> bytes;
  REQUIRE(cv::imencode(extension, image, bytes, options));
  return {bytes.begin(), bytes.end()};
}

/// As OpenCV decodes it, in RGB.
cv::Mat by_opencv(const std::string& bytes) {
  cv::Mat image = cv::imdecode(std::vector<uchar>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
  cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  return image;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

}  // namespace

TEST_CASE("headers tell size and depth without decoding") {
  for (cv::Size size : {cv::Size(1, 1), cv::Size(640, 3), cv::Size(17, 480)}) {
    const auto png = read_image_header(encoded(".png", noise(size)));
    REQUIRE(png);
    CHECK(png->size == size);
    CHECK(png->bits_per_pixel == 24);
    const auto jpeg = read_image_header(encoded(".jpg", noise(size)));
    REQUIRE(jpeg);
    CHECK(jpeg->size == size);
  }
  CHECK(read_image_header(encoded(".png", noise({4, 4}, CV_16UC1)))->bits_per_pixel == 16);
  const std::string bytes = encoded(".jpg", noise({9, 9}));
  for (std::size_t length = 0; length < bytes.size(); ++length) read_image_header(bytes.substr(0, length));
  CHECK_FALSE(read_image_header("BM"));
}

TEST_CASE("JPEG images have the bits that OpenCV gives them") {
  for (int quality : {30, 95})
    for (cv::Size size : {cv::Size(1, 1), cv::Size(33, 17), cv::Size(64, 48)})
      for (int type : {CV_8UC1, CV_8UC3}) {
        const std::string bytes =
            encoded(".jpg", noise(size, type),
                    {cv::IMWRITE_JPEG_QUALITY, quality, cv::IMWRITE_JPEG_PROGRESSIVE, quality > 50});
        CHECK(same(decode_jpeg(bytes, "a.jpg"), by_opencv(bytes)));
        CHECK(same(decode_colour(bytes, "a.jpg"), by_opencv(bytes)));
      }
}

TEST_CASE("a damaged JPEG is named with what is wrong, stray bytes before its end are no damage") {
  std::string bytes = encoded(".jpg", noise({64, 48}));
  std::string broken = bytes;
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i) broken[i] = '\xff';
  CHECK(contains(input_error([&] { decode_colour(broken, "a.jpg"); }),
                 "a.jpg: is not a readable image; it is damaged or cut off ("));
  CHECK(contains(input_error([&] { decode_colour(bytes.substr(0, bytes.size() - 2), "a.jpg"); }),
                 "a.jpg: is not a readable image"));
  std::string stray = bytes;
  stray.insert(bytes.size() - 2, "stray");
  CHECK(same(decode_colour(stray, "a.jpg"), by_opencv(bytes)));
}

TEST_CASE("a PNG is read without the parts that only annotate it; a wrong checksum is damage") {
  const cv::Mat image = noise({40, 30});
  const std::string bytes = encoded(".png", image);
  // An annotation that libpng would warn of on stderr: an iCCP chunk that makes no sense, with a wrong
  // checksum too.
  std::string annotated = bytes;
  annotated.insert(33, std::string("\0\0\0\4iCCPABCDEFGH", 16));
  CHECK(same(decode_colour(annotated, "a.png"), by_opencv(bytes)));
  std::string broken = bytes;
  broken[bytes.size() / 2] = static_cast<char>(~broken[bytes.size() / 2]);
  CHECK(contains(input_error([&] { decode_colour(broken, "a.png"); }),
                 "a.png: is damaged: a checksum is wrong"));
}

TEST_CASE("sizes are judged before anything is decoded") {
  const TemporaryFolder folder;
  const std::string bytes = encoded(".png", noise({40, 30}));
  CHECK(contains(input_error([&] {
                   decode_colour(bytes, "a.png", {80, 60});
                 }),
                 "a.png: is 40 x 30 pixels, the calibration is for 80 x 60"));
  // Of the same bytes, a header that announces 30000 x 30000 pixels.
  std::string huge = bytes;
  huge.replace(16, 8, std::string("\0\0\x75\x30\0\0\x75\x30", 8));
  CHECK(contains(input_error([&] { decode_colour(huge, "a.png"); }), "cannot hold the 30000 x 30000 pixels"));
  CHECK(contains(input_error([&] {
                   read_colour(folder.write("a.png", huge), {40, 30});
                 }),
                 "is 30000 x 30000 pixels"));
  std::string wide = encoded(".jpg", noise({40, 30}));
  const auto frame = wide.find("\xff\xc0");
  REQUIRE(frame != std::string::npos);
  wide.replace(frame + 5, 4, "\xf0\x01\xf0\x01");
  CHECK(contains(input_error([&] { decode_colour(wide, "a.jpg"); }), "cannot hold the 61441 x 61441 pixels"));
}

TEST_CASE("what does not begin as an image is not handed to a decoder") {
  for (const char* extension : {".png", ".jpg", ".tiff", ".bmp", ".pgm"})
    CHECK(is_image(encoded(extension, noise({4, 4}, CV_8UC1))));
  for (const char* bytes : {"", "P", "P9 ", "\xff\xd8\x49", "RIFF1234WAVE", "text"}) {
    CHECK_FALSE(is_image(bytes));
    CHECK(contains(input_error([&] { decode_colour(bytes, "a.jpg"); }), "a.jpg: is not a readable image"));
  }
}

TEST_CASE("a depth image of another kind is told what it has") {
  const TemporaryFolder folder;
  CHECK(contains(input_error([&] {
                   read_depth(folder.write("d.png", encoded(".png", noise({4, 4}, CV_8UC1))), {});
                 }),
                 "16 bits and one channel are needed, it has 8 bits and 1 channel"));
}
