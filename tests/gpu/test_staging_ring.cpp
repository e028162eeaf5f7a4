#include <doctest/doctest.h>

#include <atomic>
#include <optional>
#include <random>
#include <thread>

#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;
using Bytes = std::vector<uint8_t>;

namespace {

constexpr uint64_t kRing = 4096;  // pieces of a quarter: 1024

gpu::DeviceOptions small_ring() {
  gpu::DeviceOptions options = testing::device_options();
  options.staging_bytes = kRing;
  return options;
}

Bytes some_bytes(uint64_t count, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
  return bytes;
}

Bytes read(const gpu::Buffer& buffer, uint64_t offset, uint64_t count) {
  Bytes bytes(count);
  buffer.download(bytes.data(), offset, count);
  return bytes;
}

}  // namespace

TEST_CASE("transfers of any size go through a small ring, at any offset") {
  gpu::Device device(small_ring());
  gpu::Buffer buffer(device, "bytes", 40000);
  Bytes expected = some_bytes(40000, 1);
  buffer.upload(expected.data(), 0, expected.size());
  unsigned seed = 2;
  for (const uint64_t size : {0, 1, 2, 3, 15, 63, 64, 65, 1023, 1024, 1025, 2048, 4095, 4096, 4097, 30001})
    for (const uint64_t offset : {0, 1, 4, 777}) {
      CAPTURE(size);
      CAPTURE(offset);
      const Bytes bytes = some_bytes(size, seed++);
      buffer.upload(bytes.data(), offset, size);
      std::copy(bytes.begin(), bytes.end(), expected.begin() + static_cast<std::ptrdiff_t>(offset));
      CHECK(read(buffer, offset, size) == bytes);
    }
  CHECK(read(buffer, 0, expected.size()) == expected);
  CHECK(device.validation_messages().empty());
}

TEST_CASE("uploads wait for the next submission and keep their order, round after round of the ring") {
  gpu::Device device(small_ring());
  gpu::Buffer first(device, "first", 700), second(device, "second", 300);
  Bytes last_of_first, last_of_second;
  for (unsigned i = 0; i < 100; ++i) {
    last_of_first = some_bytes(700, 2 * i);
    last_of_second = some_bytes(300, 2 * i + 1);
    first.upload(last_of_first.data(), 0, 700);
    second.upload(last_of_second.data(), 0, 300);
  }
  CHECK(read(second, 0, 300) == last_of_second);
  CHECK(read(first, 0, 700) == last_of_first);
  CHECK(device.validation_messages().empty());
}

TEST_CASE("an upload is there for what is submitted after it, not for what was recorded before") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  gpu::Array<float> offsets = testing::constant_array(device, "offsets", 64, 1);
  const gpu::Array<float> values = testing::constant_array(device, "values", 64, 0);
  gpu::Recorder recorder(device);
  scale.record(recorder, offsets, values, 64);
  offsets.upload(std::vector<float>(64, 5));  // ahead of the dispatch, which is not submitted yet
  recorder.submit();
  offsets.upload(std::vector<float>(64, 7));  // behind it
  scale.record(recorder, offsets, values, 64);
  recorder.submit();
  CHECK(values.download(64) == std::vector<float>(64, 12));
}

TEST_CASE("an upload takes no submission of its own, and a download one") {
  gpu::Device& device = testing::device();
  gpu::Array<float> array(device, "array", 1000);
  device.finish_uploads();
  const gpu::DeviceCounters before = device.counters();
  for (int i = 0; i < 10; ++i) array.upload(std::vector<float>(1000, static_cast<float>(i)));
  CHECK((device.counters() - before).submissions == 0);
  gpu::Recorder recorder(device);
  recorder.submit();
  CHECK((device.counters() - before).submissions == 1);
  array.upload(std::vector<float>(10, 11));
  CHECK(array.download(11) == std::vector<float>{11, 11, 11, 11, 11, 11, 11, 11, 11, 11, 9});
  CHECK((device.counters() - before).submissions == 2);
  device.finish_uploads();
  CHECK((device.counters() - before).submissions == 2);  // there was nothing to finish
  array.upload(std::vector<float>(10, 12));
  device.finish_uploads();
  const gpu::DeviceCounters use = device.counters() - before;
  CHECK(use.submissions == 3);
  CHECK(use.bytes_uploaded == 10 * 4000 + 2 * 40);
  CHECK(use.bytes_read_back == 44);
  CHECK(use.allocations == 0);
}

TEST_CASE("a buffer may go while an upload to it waits or is under way") {
  gpu::Device device(small_ring());
  gpu::Buffer stays(device, "stays", 3000);
  const Bytes bytes = some_bytes(3000, 1);
  for (int i = 0; i < 20; ++i) {
    std::optional<gpu::Buffer> goes(std::in_place, device, "goes", 3000);
    goes->upload(bytes.data(), 0, 600);
    stays.upload(bytes.data(), 0, 100);
    if (i % 2) goes->upload(bytes.data(), 0, 3000);  // more than half of the ring: under way
    goes.reset();
  }
  stays.upload(bytes.data() + 100, 100, 2900);
  CHECK(read(stays, 0, 3000) == bytes);
  {
    gpu::Buffer dropped(device, "dropped", 16);
    dropped.upload(bytes.data(), 0, 16);
  }
  CHECK(read(stays, 0, 3000) == bytes);
  CHECK(device.validation_messages().empty());
}

TEST_CASE("the ring fills up and empties while another thread keeps the device busy") {
  gpu::Device device(small_ring());
  const testing::Scale scale(device);
  const auto ones = testing::constant_array(device, "ones", 20000, 1);
  const auto values = testing::constant_array(device, "values", 20000, 0);
  std::atomic<bool> done{false};
  std::thread busy([&] {
    gpu::Recorder recorder(device);
    while (!done) {
      for (int i = 0; i < 20; ++i) scale.record(recorder, ones, values, 20000);
      recorder.submit();
    }
  });
  gpu::Buffer buffer(device, "buffer", 700);
  Bytes last;
  for (unsigned i = 0; i < 3000; ++i) {
    last = some_bytes(700, i);
    buffer.upload(last.data(), 0, 700);
  }
  CHECK(read(buffer, 0, 700) == last);
  done = true;
  busy.join();
  CHECK(device.validation_messages().empty());
}

TEST_CASE("several threads share the ring, with transfers larger than it among theirs") {
  for (const uint64_t ring : {kRing, uint64_t{1} << 20}) {
    gpu::DeviceOptions options = small_ring();
    options.staging_bytes = ring;
    gpu::Device device(options);
    const testing::Scale scale(device);
    std::atomic<int> correct{0};
    std::vector<std::thread> workers;
    for (unsigned t = 0; t < 4; ++t)
      workers.emplace_back([&, t] {
        std::mt19937 random(t);
        bool good = true;
        for (unsigned round = 0; round < 30; ++round) {
          const uint32_t count = 1 + static_cast<uint32_t>(random() % 3000);
          gpu::Array<float> offsets(device, "offsets", count), values(device, "values", count);
          offsets.upload(std::vector<float>(count, static_cast<float>(t)));
          values.upload(std::vector<float>(count, static_cast<float>(round)));
          gpu::Recorder recorder(device);
          scale.record(recorder, offsets, values, count);
          if (round % 3) recorder.submit();  // else the recording and, perhaps, the uploads are dropped
          const float expected = static_cast<float>(round % 3 ? round + t : round);
          good = good && values.download(count) == std::vector<float>(count, expected);
        }
        if (good) ++correct;
      });
    for (std::thread& worker : workers) worker.join();
    CHECK(correct == 4);
    CHECK(device.validation_messages().empty());
  }
}
