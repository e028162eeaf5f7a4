#include "engine/sources/frame_stream.h"

#include <new>

#include "engine/sources/open_dataset.h"
#include "tests/sources/fake_recording.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::FakeRecording;
using test::input_error;

namespace {

FrameSelection select(int start, int stride, int frames) {
  FrameSelection selection;
  selection.start = start;
  selection.stride = stride;
  selection.frames = frames;
  return selection;
}

std::vector<int> indices(FrameStream& stream) {
  std::vector<int> result;
  while (const auto frame = stream.next()) {
    CHECK(frame->colour.at<cv::Vec3b>(0, 0)[0] == frame->index);
    result.push_back(frame->index);
  }
  return result;
}

}  // namespace

TEST_CASE("start, stride and frames select, in order") {
  const FakeRecording recording(10);
  FrameStream all(recording, {});
  CHECK(all.size() == 10);
  CHECK(indices(all) == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK_FALSE(all.next());
  FrameStream some(recording, select(1, 3, 0));
  CHECK(some.size() == 3);
  CHECK(indices(some) == std::vector<int>{1, 4, 7});
  FrameStream few(recording, select(2, 2, 2));
  CHECK(indices(few) == std::vector<int>{2, 4});
  FrameStream more_than_there_are(recording, select(8, 1, 100));
  CHECK(indices(more_than_there_are) == std::vector<int>{8, 9});
}

TEST_CASE("bad frames are skipped, counted and named; exceptions do not stop the stream") {
  FakeRecording recording(6);
  recording.missing = 1;
  recording.throwing = 4;
  FrameStream stream(recording, {});
  CHECK(stream.next()->index == 0);
  CHECK(stream.problems().empty());
  CHECK(stream.next()->index == 2);
  REQUIRE(stream.problems().size() == 1);
  CHECK(indices(stream) == std::vector<int>{3, 5});
  REQUIRE(stream.problems().size() == 2);
  CHECK(stream.problems()[0].index == 1);
  CHECK(stream.problems()[0].reason == "file is missing");
  CHECK(stream.problems()[1].index == 4);
  CHECK(stream.problems()[1].reason == "decoder failed");
}

TEST_CASE("lack of memory reaches the consumer after the frames before it") {
  FakeRecording recording(6);
  recording.out_of_memory = 2;
  FrameStream stream(recording, {});
  CHECK(stream.next()->index == 0);
  CHECK(stream.next()->index == 1);
  CHECK_THROWS_AS(stream.next(), std::bad_alloc);
}

TEST_CASE("decoding runs ahead by a few frames only and stops when the stream goes away") {
  const FakeRecording recording(1000);
  {
    FrameSelection selection;
    selection.ahead = 3;
    FrameStream stream(recording, selection);
    CHECK(stream.next()->index == 0);
  }
  CHECK(recording.loads <= 1 + 3 + 1);
  for (int i = 0; i < 100; ++i) FrameStream(recording, {});
}

TEST_CASE("a selection out of range is refused") {
  const FakeRecording recording(10);
  const auto error = [&](const FrameSelection& selection) {
    return input_error([&] { FrameStream(recording, selection); });
  };
  CHECK(contains(error(select(10, 1, 0)), "start is 10, but the frames of fake are 0 to 9"));
  CHECK(contains(error(select(-1, 1, 0)), "start is -1"));
  CHECK(contains(error(select(0, 0, 0)), "stride"));
  CHECK(contains(error(select(0, 1, -2)), "frames"));
  for (double scale : {0.0, -1.0, 1.5, 0.01}) {
    FrameSelection selection;
    selection.scale = scale;
    CHECK(contains(error(selection), "scale"));
  }
}

TEST_CASE("resizing agrees with Intrinsics::scaled to a fraction of a pixel, at any scale and odd sizes") {
  // Colour and depth encode their own column and row, so that each new pixel tells where it came from.
  constexpr int width = 85;
  constexpr int height = 67;
  Frame frame;
  frame.colour.create(height, width, CV_8UC3);
  frame.depth.create(height, width, CV_32FC1);
  Frame rows = frame;
  rows.depth = frame.depth.clone();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      frame.colour.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<uchar>(2 * x), static_cast<uchar>(2 * y), 7);
      // Neighbours in the other direction are other surfaces, so that they are not averaged.
      frame.depth.at<float>(y, x) = static_cast<float>(1000 * y + x);
      rows.depth.at<float>(y, x) = static_cast<float>(1000 * x + y);
    }
  }
  for (double scale : {0.5, 0.25, 1.0 / 3, 0.3, 0.7, 0.9, 1.0}) {
    CAPTURE(scale);
    const Frame small = resize_frame(frame, scale), turned = resize_frame(rows, scale);
    const Intrinsics expected = Intrinsics{width, height, 1, 1, 0, 0}.scaled(scale);
    REQUIRE(small.colour.size() == cv::Size(expected.width, expected.height));
    REQUIRE(small.depth.size() == small.colour.size());
    for (int x = 1; x + 1 < small.colour.cols; ++x) {
      const double source = (x + 0.5) / scale - 0.5;
      // 8-bit rounding of twice the column, and the weights of partly covered pixels.
      CHECK(std::abs(small.colour.at<cv::Vec3b>(3, x)[0] / 2.0 - source) < 0.51);
      CHECK(std::abs(std::fmod(small.depth.at<float>(3, x), 1000.0f) - source) <= 0.5 + 1e-6);
    }
    for (int y = 1; y + 1 < small.colour.rows; ++y) {
      const double source = (y + 0.5) / scale - 0.5;
      CHECK(std::abs(small.colour.at<cv::Vec3b>(y, 3)[1] / 2.0 - source) < 0.51);
      CHECK(std::abs(std::fmod(turned.depth.at<float>(y, 3), 1000.0f) - source) <= 0.5 + 1e-6);
    }
  }
}

TEST_CASE("resizing leaves slanted planes where they are, and does not blend surfaces or fill holes") {
  constexpr int width = 86;
  constexpr int height = 64;
  // 1 / depth is linear over the image of a plane.
  const auto plane = [](double x, double y) { return 1 / (0.5 + 0.002 * x - 0.0015 * y); };
  Frame frame;
  frame.colour = cv::Mat::zeros(height, width, CV_8UC3);
  frame.depth.create(height, width, CV_32FC1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) frame.depth.at<float>(y, x) = static_cast<float>(plane(x, y));
  for (double scale : {0.5, 0.25, 1.0 / 3, 0.3, 0.7}) {
    CAPTURE(scale);
    const Frame small = resize_frame(frame, scale);
    // Partly covered pixels count by their share, but at their centres, as colour does.
    const double tolerance = std::abs(1 / scale - std::round(1 / scale)) < 1e-9 ? 1e-6 : 1e-3;
    double worst = 0;
    for (int y = 1; y + 1 < small.depth.rows; ++y)
      for (int x = 1; x + 1 < small.depth.cols; ++x) {
        const double expected = plane((x + 0.5) / scale - 0.5, (y + 0.5) / scale - 0.5);
        worst = std::max(worst, std::abs(small.depth.at<float>(y, x) / expected - 1));
      }
    CHECK(worst < tolerance);
  }
  frame.depth.colRange(40, width) = 4.0f;
  frame.depth.rowRange(20, 30) = 0.0f;
  const Frame small = resize_frame(frame, 0.25);
  for (int y = 0; y < small.depth.rows; ++y)
    for (int x = 0; x < small.depth.cols; ++x) {
      const float z = small.depth.at<float>(y, x);
      const bool hole = 4 * y + 2 >= 20 && 4 * y + 2 < 30;
      CHECK((z == 0) == hole);
      if (!hole) CHECK(std::abs(z - 4) * (x >= 10 ? 1.0f : 0.0f) == 0);
      if (!hole && x < 10) CHECK(z < 3);
    }
}

TEST_CASE("a real clip streams at half size with matching intrinsics") {
  const auto folder = test::real_clip("tum_fr1_xyz");
  if (folder.empty()) return;
  const auto dataset = open_dataset(folder);
  FrameSelection selection = select(10, 5, 4);
  selection.scale = 0.5;
  FrameStream stream(*dataset.recording, selection);
  CHECK(stream.intrinsics().width == 320);
  CHECK(stream.intrinsics().cx == 0.5 * (318.6 + 0.5) - 0.5);
  int count = 0;
  while (const auto frame = stream.next()) {
    CHECK(frame->index == 10 + 5 * count++);
    CHECK(frame->colour.size() == cv::Size(320, 240));
    CHECK(frame->depth.size() == cv::Size(320, 240));
  }
  CHECK(count == 4);
  CHECK(stream.problems().empty());
}
