// What is recorded must happen in the order of recording, wherever two steps touch the same buffer. A missing
// barrier shows twice: in the values on hardware that runs ahead, and in synchronisation validation, which
// fails the program.
#include <doctest/doctest.h>

#include "shaders/shared/test_arguments.h"
#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::constant_array;
using testing::first_entries;

namespace {

constexpr uint32_t kCount = 5000;
constexpr uint32_t kBitsOfOne = 0x3f800000, kBitsOfTwo = 0x40000000;  // 1.0f and 2.0f as fills write them

void check_all(const gpu::Array<float>& array, float expected) {
  CHECK(array.download(kCount) == std::vector<float>(kCount, expected));
}

}  // namespace

TEST_CASE("hazards between passes") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto a = constant_array(device, "a", kCount, 1), b = constant_array(device, "b", kCount, 2),
             c = constant_array(device, "c", kCount, 4);
  gpu::Recorder recorder(device);
  scale.record(recorder, a, b, kCount);     // b = 3
  scale.record(recorder, b, c, kCount);     // read after write: c = 7
  scale.record(recorder, a, b, kCount, 2);  // write after read, after write: b = 7
  scale.record(recorder, c, a, kCount);     // write after an older read: a = 8
  recorder.submit();
  check_all(a, 8);
  check_all(b, 7);
  check_all(c, 7);
}

TEST_CASE("hazards between fills and passes") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto a = constant_array(device, "a", kCount, 0), b = constant_array(device, "b", kCount, 0);
  gpu::Recorder recorder(device);
  recorder.fill(a, kCount, kBitsOfTwo);
  recorder.fill(a, kCount, kBitsOfOne);  // write after write
  scale.record(recorder, a, b, kCount);  // read after fill: b = 1
  recorder.fill(a, kCount, kBitsOfTwo);  // fill after read
  scale.record(recorder, a, b, kCount);  // b = 3
  recorder.submit();
  check_all(a, 2);
  check_all(b, 3);

  scale.record(recorder, a, b, kCount);
  recorder.fill(b, kCount, kBitsOfOne);  // fill after a pass wrote
  recorder.submit();
  check_all(b, 1);
}

TEST_CASE("hazards between copies and passes") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto a = constant_array(device, "a", kCount, 1), b = constant_array(device, "b", kCount, 0),
             c = constant_array(device, "c", kCount, 0);
  const auto copy = [](gpu::Recorder& recorder, const auto& from, const auto& to) {
    recorder.copy(first_entries(from, kCount), first_entries(to, kCount));
  };
  gpu::Recorder recorder(device);
  copy(recorder, a, b);                  // b = 1
  copy(recorder, b, c);                  // read after write: c = 1
  scale.record(recorder, c, b, kCount);  // pass after copy: b = 2
  copy(recorder, b, a);                  // copy after pass, over what a copy read: a = 2
  scale.record(recorder, c, b, kCount);  // pass over what a copy read: b = 3
  copy(recorder, a, c);                  // copy over what a pass read: c = 2
  recorder.submit();
  check_all(a, 2);
  check_all(b, 3);
  check_all(c, 2);
}

TEST_CASE("hazards around the arguments of indirect dispatches") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const gpu::Pass<passes::test_arguments> set_arguments(device, 1);
  const auto ones = constant_array(device, "ones", kCount, 1),
             sums = constant_array(device, "sums", kCount, 0);
  gpu::Array<gpu::DispatchArgs> arguments(device, "arguments", 2), zero(device, "no workgroups", 2);
  zero.upload(std::vector<gpu::DispatchArgs>(2, {0, 1, 1}));
  const uint32_t all = scale.pass().groups(kCount);
  gpu::Recorder recorder(device);
  const auto add_indirectly = [&] {
    recorder.dispatch_indirect(scale.pass(), arguments, 1, {.offsets = ones, .values = sums},
                               {.count = kCount, .factor = 1});
  };
  recorder.dispatch(set_arguments, 2, {.args = arguments}, {.count = 2, .groups = all});
  add_indirectly();  // arguments from a pass: 1
  recorder.copy(first_entries(zero, 2), first_entries(arguments, 2));
  add_indirectly();  // from a copy, after an indirect read: nothing happens
  recorder.dispatch(set_arguments, 2, {.args = arguments}, {.count = 2, .groups = all});
  add_indirectly();  // 2
  recorder.fill(arguments, 2, 0);
  add_indirectly();  // from a fill: nothing happens
  recorder.submit();
  check_all(sums, 2);
}

TEST_CASE("work of one submission is visible to the next, from another recorder too") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto a = constant_array(device, "a", kCount, 1), b = constant_array(device, "b", kCount, 0);
  gpu::Recorder first(device), second(device);
  scale.record(first, a, b, kCount);  // recorded before, submitted between
  scale.record(second, b, a, kCount);
  first.submit();
  second.submit();
  scale.record(first, a, b, kCount);
  first.submit();
  check_all(a, 2);
  check_all(b, 3);
}
