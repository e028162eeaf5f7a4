// The framed stream as a source: every frame, or the newest.
#include "engine/sources/stream_source.h"

#include <doctest/doctest.h>

#include <future>
#include <thread>

#include "engine/sources/frame_stream.h"
#include "engine/sources/prompt_stream.h"
#include "tests/support/input_files.h"
#include "tests/support/stream_writer.h"

using namespace surefield;
using namespace surefield::test;

namespace {

std::string frames(int first, int last) {
  std::string bytes;
  for (int i = first; i <= last; ++i) {
    FrameToSend frame;
    frame.stamp = i;
    frame.colour.assign(frame.colour.size(), static_cast<char>(i));
    bytes += frame.message();
  }
  return bytes;
}

std::string header(uint32_t flags) {
  HeaderToSend header;
  header.flags = flags;
  return header.message();
}

std::vector<int> indices(FrameSource& source) {
  std::vector<int> found;
  while (const auto frame = source.next()) {
    CHECK(frame->colour.at<cv::Vec3b>(0, 0)[0] == frame->index);
    found.push_back(frame->index);
  }
  return found;
}

/// A source over bytes that a test goes on adding to.
struct Open {
  explicit Open(const std::string& begin) {
    auto memory = std::make_unique<MemoryBytes>(begin, 1 << 20, true);
    bytes = memory.get();
    source = std::make_unique<StreamSource>(std::move(memory));
  }
  /// Waits until so many frames have arrived.
  void wait_for(uint64_t count) const {
    while (source->live()->arrived < count) std::this_thread::yield();
  }
  MemoryBytes* bytes = nullptr;
  std::unique_ptr<StreamSource> source;
};

}  // namespace

TEST_CASE("where every frame counts none is dropped, and they go through a stream that decodes ahead") {
  StreamSource source(std::make_unique<MemoryBytes>(header(1) + frames(0, 9) + end_message()));
  CHECK(source.name() == "bench camera");
  CHECK(source.format() == "live");
  CHECK_FALSE(source.live());
  CHECK_FALSE(source.size());
  FrameStream stream(source, {.start = 1, .stride = 2});
  CHECK(indices(stream) == std::vector<int>{1, 3, 5, 7, 9});
  CHECK_FALSE(source.ended_early());
}

TEST_CASE("else the newest frame wins, and those that nobody took are counted") {
  Open open(header(0));
  open.bytes->add(frames(0, 4));
  open.wait_for(5);
  auto frame = open.source->next();
  REQUIRE(frame);
  CHECK(frame->index == 4);
  CHECK(frame->arrived);
  open.bytes->add(frames(5, 5));
  CHECK(open.source->next()->index == 5);
  open.bytes->add(frames(6, 8) + end_message());
  open.wait_for(9);
  CHECK(open.source->next()->index == 8);
  CHECK_FALSE(open.source->next());
  const LiveCounts counts = *open.source->live();
  CHECK(counts.arrived == 9);
  CHECK(counts.dropped == 6);
  CHECK(counts.seconds >= 0);
  CHECK(open.source->problems().empty());
}

TEST_CASE("the newest frame that came before a sender went away is given, and what is wrong after it") {
  Open open(header(0));
  open.bytes->add(frames(0, 1));
  open.wait_for(2);
  SUBCASE("gone") {
    open.bytes->close();
    CHECK(open.source->next()->index == 1);
    CHECK_FALSE(open.source->next());
    CHECK(open.source->ended_early());
  }
  SUBCASE("no stream any more") {
    open.bytes->add("garbage!");
    CHECK(open.source->next()->index == 1);
    CHECK(contains(input_error([&] { open.source->next(); }), "message 4"));
  }
  SUBCASE("a frame that cannot be used") {
    FrameToSend back;
    open.bytes->add(back.message() + end_message());
    CHECK(open.source->next()->index == 1);
    CHECK_FALSE(open.source->next());
    REQUIRE(open.source->problems().size() == 1);
    CHECK(open.source->problems()[0].index == 2);
  }
}

TEST_CASE("a source that waits for a frame is ended by stop(), from another thread") {
  for (const uint32_t flags : {0u, 1u}) {
    Open open(header(flags));
    auto waiting = std::async(std::launch::async, [&] { return open.source->next().has_value(); });
    open.source->stop();
    CHECK_FALSE(waiting.get());
    CHECK_FALSE(open.source->next());
    CHECK(open.source->problems().empty());
  }
}

TEST_CASE("a stream of a live source selects and resizes, and asks for no frame before it is asked") {
  auto memory = std::make_unique<MemoryBytes>(header(1), 1 << 20, true);
  MemoryBytes& bytes = *memory;
  StreamSource source(std::move(memory));
  PromptStream stream(source, {.start = 1, .stride = 2, .frames = 2, .scale = 0.5});
  CHECK(stream.intrinsics().width == 4);
  bytes.add(frames(0, 3));
  const auto first = stream.next();
  REQUIRE(first);
  CHECK(first->index == 1);
  CHECK(first->depth.cols == 4);
  CHECK(source.next()->index == 2);  // nobody has taken it
  bytes.add(frames(4, 4));
  CHECK(stream.next()->index == 4);
  CHECK_FALSE(stream.next());
  CHECK(contains(input_error([&] { PromptStream(source, {.stride = 0}); }), "stride"));
  CHECK(contains(input_error([&] { PromptStream(source, {.start = -1}); }), "start is -1"));
}

TEST_CASE("a live source of which no frame can be read is given up") {
  std::string bytes = header(0);
  FrameToSend bad;
  bad.colour_kind = 9;
  for (int i = 0; i < 6; ++i) bytes += bad.message();
  StreamSource source(std::make_unique<MemoryBytes>(bytes + end_message()));
  PromptStream stream(source, {.hopeless = 5});
  CHECK(contains(input_error([&] { stream.next(); }), "none of the first"));
}
