#include <doctest/doctest.h>

#include <algorithm>

#include "engine/gpu/device_report.h"
#include "engine/gpu/error.h"
#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

gpu::DeviceReport report(uint32_t index, const std::string& name, const std::string& type) {
  gpu::DeviceReport made;
  made.index = index;
  made.name = name;
  made.type = type;
  return made;
}

gpu::Error::Kind kind_thrown(const std::vector<gpu::DeviceReport>& reports, const std::string& selector) {
  try {
    gpu::select_device(reports, selector);
  } catch (const gpu::Error& error) {
    return error.kind();
  }
  return gpu::Error::Kind::Driver;
}

}  // namespace

TEST_CASE("the list of devices contains the one that is open") {
  const auto devices = gpu::list_devices();
  const gpu::DeviceReport& open = testing::device().report();
  REQUIRE(open.index < devices.size());
  CHECK(devices[open.index].name == open.name);
  CHECK(open.missing.empty());
  CHECK(open.memory_bytes > 0);
  CHECK_FALSE(open.driver.empty());
}

TEST_CASE("the limits of the open device are those that Vulkan promises") {
  const gpu::DeviceLimits& limits = testing::device().limits();
  CHECK(limits.subgroup_size >= 4);
  CHECK(limits.subgroup_size <= 64);
  CHECK(limits.workgroup_invocations >= 128);
  CHECK(limits.workgroups_x >= 65535);
  CHECK(limits.workgroups_y >= 65535);
  CHECK(limits.shared_memory_bytes >= 16384);
  CHECK(limits.storage_range_bytes >= uint64_t{1} << 27);
  CHECK(limits.is_cpu == (testing::device().report().type == "CPU"));
}

TEST_CASE("devices are chosen by index, by part of the name, or by kind") {
  std::vector<gpu::DeviceReport> reports{
      report(0, "llvmpipe (LLVM 15)", "CPU"), report(1, "Small", "integrated GPU"),
      report(2, "GeForce RTX 4090", "discrete GPU"), report(3, "Odd", "virtual GPU")};
  CHECK(gpu::select_device(reports, "0") == 0);
  CHECK(gpu::select_device(reports, "3") == 3);
  CHECK(gpu::select_device(reports, "LLVMpipe") == 0);
  CHECK(gpu::select_device(reports, "rtx") == 2);
  CHECK(gpu::select_device(reports, "4090") == 2);
  CHECK(gpu::select_device(reports, "") == 2);
  reports[2].missing = {"synchronization2"};
  CHECK(gpu::select_device(reports, "") == 1);  // an unusable device is the last choice
  reports.resize(1);
  CHECK(gpu::select_device(reports, "") == 0);
}

TEST_CASE("a selector that matches nothing is an error that shows the way out") {
  const std::vector<gpu::DeviceReport> reports{report(0, "llvmpipe", "CPU")};
  CHECK(kind_thrown(reports, "geforce") == gpu::Error::Kind::NoDevice);
  CHECK(kind_thrown(reports, "1") == gpu::Error::Kind::NoDevice);
  CHECK(kind_thrown({}, "") == gpu::Error::Kind::NoDevice);
  CHECK_THROWS_WITH_AS(gpu::Device({.selector = "no such device"}),
                       "no Vulkan device matches --device no such device: `surefield devices` lists them",
                       gpu::Error);
}

TEST_CASE("an unknown shader is an error") {
  CHECK_THROWS_WITH_AS(gpu::spirv("no_such_pass"), "no shader named no_such_pass", gpu::Error);
}

TEST_CASE("validation reports a missing barrier") {
  gpu::Device device(testing::device_options());
  gpu::Array<float> a(device, "a", 64), b(device, "b", 64), c(device, "c", 64);
  CHECK(device.validation_messages().empty());
  gpu::Recorder recorder(device);
  recorder.copy_raw(a.buffer().handle(), 0, b.buffer().handle(), 0, 256);
  recorder.copy_raw(b.buffer().handle(), 0, c.buffer().handle(), 0, 256);  // nothing waits for the first copy
  recorder.submit();
  const auto messages = device.validation_messages();
  REQUIRE_FALSE(messages.empty());
  CHECK(messages[0].find("SYNC-HAZARD-READ-AFTER-WRITE") != std::string::npos);
}

TEST_CASE("validation reports a misuse of the interface") {
  gpu::Device device(testing::device_options());
  gpu::Array<float> a(device, "a", 64), b(device, "b", 64);
  gpu::Recorder recorder(device);
  recorder.copy_raw(a.buffer().handle(), 0, b.buffer().handle(), 0, 512);  // beyond both ends
  CHECK_FALSE(device.validation_messages().empty());
}

TEST_CASE("a device without validation collects no messages") {
  gpu::DeviceOptions options = testing::device_options();
  options.validate = false;
  gpu::Device device(options);
  const testing::Scale scale(device);
  const auto ones = testing::constant_array(device, "ones", 64, 1),
             values = testing::constant_array(device, "v", 64, 0);
  gpu::Recorder recorder(device);
  scale.record(recorder, ones, values, 64);
  recorder.submit();
  CHECK(values.download(64) == std::vector<float>(64, 1.0f));
  CHECK(device.validation_messages().empty());
}
