// The framed stream: the header, the messages, and the images in them.
#include <vector>

#include "engine/sources/stream_reader.h"
#include "tests/fuzz/harness.h"
#include "tests/support/stream_writer.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  using namespace surefield;
  test::MemoryBytes bytes(std::string(reinterpret_cast<const char*>(data), size), 4096);
  fuzz::expect_answer([&] {
    StreamReader reader(bytes);
    const StreamDecoder decoder(reader.header());
    std::vector<SkippedFrame> refused;
    while (const auto frame = reader.next(refused)) fuzz::expect_answer([&] { decoder.decode(*frame); });
    for (const SkippedFrame& skipped : refused)
      if (skipped.reason.find('\n') != std::string::npos) __builtin_trap();
  });
  return 0;
}
