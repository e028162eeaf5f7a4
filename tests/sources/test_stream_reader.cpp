// The framed stream: what is read of it, and that nothing in it is trusted.
#include "engine/sources/stream_reader.h"

#include <doctest/doctest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "tests/support/input_files.h"
#include "tests/support/stream_writer.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// What a stream came to.
struct Reading {
  std::vector<Frame> frames;
  std::vector<SkippedFrame> refused;
  bool ended_early = false;
};

Reading read_all(const std::string& bytes, std::size_t most = 4096) {
  MemoryBytes source(bytes, most);
  StreamReader reader(source);
  const StreamDecoder decoder(reader.header());
  Reading reading;
  while (const auto stored = reader.next(reading.refused)) {
    try {
      reading.frames.push_back(decoder.decode(*stored));
    } catch (const InputError& error) {
      reading.refused.push_back({stored->index, error.what()});
    }
  }
  reading.ended_early = reader.ended_early();
  return reading;
}

std::string header_problem(const HeaderToSend& header) {
  return input_error([&] { read_all(header.message() + end_message()); });
}

/// Why the frame in the middle of three is refused; the others must come.
std::string frame_problem(const FrameToSend& frame) {
  FrameToSend first, last;
  last.stamp = 2;
  const Reading reading =
      read_all(HeaderToSend().message() + first.message() + frame.message() + last.message() + end_message());
  CHECK(reading.frames.size() == 2);
  CHECK_FALSE(reading.ended_early);
  REQUIRE(reading.refused.size() == 1);
  CHECK(reading.refused[0].index == 1);
  CHECK(contains(reading.refused[0].reason, "message 3"));
  CHECK_FALSE(contains(reading.refused[0].reason, "\n"));
  return reading.refused[0].reason;
}

cv::Mat noise(int type, double least, double most) {
  cv::Mat image(6, 8, type);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, least, most);
  return image;
}

std::string encoded(const char* extension, const cv::Mat& image) {
  std::vector<uchar> bytes;
  REQUIRE(cv::imencode(extension, image, bytes));
  return {bytes.begin(), bytes.end()};
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && pixels_of(a) == pixels_of(b);
}

}  // namespace

TEST_CASE("a header says what it says") {
  HeaderToSend sent;
  sent.flags = 5;
  sent.camera = {525, 524, 4.25, 2.75};
  sent.depth_unit = 0.0002;
  sent.coefficients = 5;
  sent.distortion = {0.25, -0.5, 0.01, 0.02, 1};
  sent.name = "porch\ncamera";
  MemoryBytes bytes(sent.message());
  const StreamReader reader(bytes);
  const StreamHeader& header = reader.header();
  CHECK(header.name == "porch?camera");
  CHECK(header.every_frame);
  CHECK_FALSE(header.wants_poses);
  CHECK(header.unix_stamps);
  CHECK(header.camera.intrinsics.width == 8);
  CHECK(header.camera.intrinsics.height == 6);
  CHECK(header.camera.intrinsics.fx == 525);
  CHECK(header.camera.intrinsics.cy == 2.75);
  CHECK(header.camera.depth_unit == 0.0002);
  CHECK(header.camera.distortion.coefficients == std::vector<double>{0.25, -0.5, 0.01, 0.02, 1});
}

TEST_CASE("frames of every encoding are what was sent, bit for bit") {
  const cv::Mat colour = noise(CV_8UC3, 0, 256), steps = noise(CV_16UC1, 0, 65536);
  cv::Mat bgr;
  cv::cvtColor(colour, bgr, cv::COLOR_RGB2BGR);
  cv::Mat metres(6, 8, CV_32FC1);
  for (int i = 0; i < 48; ++i)
    metres.at<float>(i / 8, i % 8) = static_cast<float>(steps.at<uint16_t>(i / 8, i % 8) * 0.001);
  FrameToSend frame;
  SUBCASE("raw") {
    frame.colour = pixels_of(colour);
    frame.depth = pixels_of(steps);
  }
  SUBCASE("BGR, and metres") {
    frame.colour_kind = 1;
    frame.colour = pixels_of(bgr);
    frame.depth_kind = 2;
    frame.depth = pixels_of(metres);
  }
  SUBCASE("PNG") {
    frame.colour_kind = 3;
    frame.colour = encoded(".png", bgr);
    frame.depth_kind = 1;
    frame.depth = encoded(".png", steps);
  }
  frame.stamp = 12.5;
  frame.depth_after = 0.0625;
  for (const std::size_t most : {1, 4096}) {
    const Reading reading = read_all(HeaderToSend().message() + frame.message() + end_message(), most);
    CHECK(reading.refused.empty());
    CHECK_FALSE(reading.ended_early);
    REQUIRE(reading.frames.size() == 1);
    CHECK(reading.frames[0].index == 0);
    CHECK(reading.frames[0].timestamp == 12.5);
    CHECK(reading.frames[0].depth_after == 0.0625);
    CHECK(same(reading.frames[0].colour, colour));
    CHECK(same(reading.frames[0].depth, metres));
  }
}

TEST_CASE("depth in metres that is none is no depth") {
  cv::Mat metres(6, 8, CV_32FC1, cv::Scalar(2));
  metres.at<float>(0, 0) = NAN;
  metres.at<float>(0, 1) = -1;
  metres.at<float>(0, 2) = INFINITY;
  FrameToSend frame;
  frame.depth_kind = 2;
  frame.depth = pixels_of(metres);
  const Reading reading = read_all(HeaderToSend().message() + frame.message() + end_message());
  REQUIRE(reading.frames.size() == 1);
  for (int u = 0; u < 3; ++u) CHECK(reading.frames[0].depth.at<float>(0, u) == 0);
  CHECK(reading.frames[0].depth.at<float>(0, 3) == 2);
}

TEST_CASE("images of a lens with distortion are straightened") {
  HeaderToSend header;
  header.coefficients = 4;
  header.distortion[0] = 0.3;
  FrameToSend frame;
  frame.colour = pixels_of(noise(CV_8UC3, 0, 256));
  const Reading bent = read_all(HeaderToSend().message() + frame.message() + end_message());
  const Reading straight = read_all(header.message() + frame.message() + end_message());
  REQUIRE(straight.frames.size() == 1);
  CHECK_FALSE(same(straight.frames[0].colour, bent.frames.at(0).colour));
}

TEST_CASE("headers that no camera sends are refused in one line") {
  const auto with = [](auto change) {
    HeaderToSend header;
    change(header);
    return header_problem(header);
  };
  CHECK(contains(with([](auto& h) { h.version = 2; }), "version 2"));
  CHECK(contains(with([](auto& h) { h.flags = 8; }), "flags"));
  CHECK(contains(with([](auto& h) { h.width = 0; }), "width is 0"));
  CHECK(contains(with([](auto& h) { h.height = 4000000000; }), "height is"));
  CHECK(contains(with([](auto& h) { h.width = h.height = 8192; }), "pixels"));
  CHECK(contains(with([](auto& h) { h.camera[0] = -5; }), "fx is -5"));
  CHECK(contains(with([](auto& h) { h.camera[3] = NAN; }), "cy is nan"));
  CHECK(contains(with([](auto& h) { h.depth_unit = 0; }), "depth unit"));
  CHECK(contains(with([](auto& h) { h.coefficients = 3; }), "3 coefficients"));
  CHECK(contains(with([](auto& h) { h.model = 1, h.coefficients = 5; }), "5 coefficients"));
  CHECK(contains(with([](auto& h) { h.model = 2; }), "model of distortion is 2"));
  CHECK(contains(with([](auto& h) { h.coefficients = 4, h.distortion[2] = INFINITY; }), "coefficient"));
  CHECK(header_problem(HeaderToSend()) == "");
  CHECK(contains(input_error([] { read_all(""); }), "before it sent anything"));
  CHECK(contains(input_error([] { read_all("SF"); }), "begins with"));
  CHECK(contains(input_error([] { read_all("RIFF....AVI "); }), "\"RIFF\""));
  CHECK(contains(input_error([] { read_all(HeaderToSend().message().substr(0, 100)); }), "cut off"));
  CHECK(contains(input_error([] { read_all(stream_message("SFLH", "short")); }), "5 bytes where 240"));
}

TEST_CASE("frames that contradict themselves cost no other frame") {
  FrameToSend frame;
  frame.stamp = 1;
  SUBCASE("an unknown encoding") {
    frame.colour_kind = 4;
    CHECK(contains(frame_problem(frame), "unknown encodings, 4 of colour"));
  }
  SUBCASE("too few pixels") {
    frame.colour.resize(100);
    CHECK(contains(frame_problem(frame), "100 bytes of colour do not fit 48 pixels"));
  }
  SUBCASE("too few depths") {
    frame.depth_kind = 2;
    CHECK(contains(frame_problem(frame), "96 bytes of depth do not fit 48 pixels"));
  }
  SUBCASE("no stamp") {
    frame.stamp = NAN;
    CHECK(contains(frame_problem(frame), "no number of seconds"));
  }
  SUBCASE("a stamp again") {
    frame.stamp = 0;
    CHECK(contains(frame_problem(frame), "0.000000 s, does not lie after"));
  }
  SUBCASE("a stamp that goes back") {
    frame.stamp = -3;
    CHECK(contains(frame_problem(frame), "-3.000000 s"));
  }
  SUBCASE("an image that is none") {
    frame.colour_kind = 2;
    CHECK(contains(frame_problem(frame), "its colour"));
  }
  SUBCASE("an image of another size") {
    frame.depth_kind = 1;
    frame.depth = encoded(".png", cv::Mat(7, 8, CV_16UC1, cv::Scalar(1)));
    CHECK(contains(frame_problem(frame), "8 x 7 pixels"));
  }
}

TEST_CASE("lengths inside of a frame that add up to another one are refused") {
  std::string message = FrameToSend().message();
  const uint32_t lie = 0xffffffff;
  message.replace(8 + 24, 4, bytes_of(lie));
  const Reading reading =
      read_all(HeaderToSend().message() + message + FrameToSend().message() + end_message());
  REQUIRE(reading.refused.size() == 1);
  CHECK(contains(reading.refused[0].reason, "message 2: 4294967295 bytes of colour"));
  CHECK(reading.frames.size() == 1);
}

TEST_CASE("where the next message begins must be known: a length that lies ends the stream, by its number") {
  const std::string begin = HeaderToSend().message() + FrameToSend().message();
  CHECK(contains(input_error([&] { read_all(begin + "SFLF" + bytes_of(uint32_t{0x7fffffff})); }),
                 "message 3 of the stream claims 2147483647 bytes"));
  CHECK(contains(input_error([&] { read_all(begin + "SFLF" + bytes_of(uint32_t{31})); }), "claims 31 bytes"));
  CHECK(contains(input_error([&] { read_all(begin + std::string("\x01\x02\x03\x04garbage")); }),
                 "message 3 of the stream begins with the bytes 01 02 03 04"));
  CHECK(contains(input_error([&] { read_all(begin + HeaderToSend().message()); }), "begins with \"SFLH\""));
}

TEST_CASE("a stream that ends anywhere gives what was whole") {
  const std::string header = HeaderToSend().message(), frame = FrameToSend().message();
  FrameToSend next;
  next.stamp = 1;
  const std::string bytes = header + frame + next.message() + end_message();
  for (std::size_t size = header.size(); size < bytes.size(); ++size) {
    CAPTURE(size);
    const Reading reading = read_all(bytes.substr(0, size));
    CHECK(reading.frames.size() == (size - header.size()) / frame.size());
    CHECK(reading.ended_early);
    CHECK(reading.refused.empty() == ((size - header.size()) % frame.size() == 0));
  }
  CHECK_FALSE(read_all(bytes).ended_early);
}

TEST_CASE("bytes that were turned over never do more than end a stream or cost frames") {
  std::string bytes = HeaderToSend().message();
  for (int i = 0; i < 4; ++i) {
    FrameToSend frame;
    frame.stamp = i;
    frame.colour_kind = 3;
    frame.colour = encoded(".png", noise(CV_8UC3, 0, 256));
    frame.depth_kind = i % 3;
    frame.depth = i % 3 == 1   ? encoded(".png", noise(CV_16UC1, 0, 65536))
                  : i % 3 == 2 ? std::string(8 * 6 * 4, '\x3f')
                               : std::string(8 * 6 * 2, '\x04');
    bytes += frame.message();
  }
  bytes += end_message();
  CHECK(read_all(bytes).frames.size() == 4);
  std::mt19937 random(5);
  for (int trial = 0; trial < 500; ++trial) {
    CAPTURE(trial);
    std::string damaged = bytes;
    for (int k = 0; k <= trial % 4; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    std::size_t frames = 0;
    input_error([&] { frames = read_all(damaged).frames.size(); });  // any other error fails the test
    CHECK(frames <= 4);
  }
}
