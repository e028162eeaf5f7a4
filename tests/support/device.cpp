#include "tests/support/device.h"

#include <cstdio>
#include <cstdlib>

namespace surefield::testing {

namespace {

/// Ends the process with an error when the validation layer had something to say.
struct CheckedDevice {
  gpu::Device device;

  explicit CheckedDevice(const gpu::DeviceOptions& options) : device(options) {}
  ~CheckedDevice() {
    const auto messages = device.validation_messages();
    for (const auto& message : messages) std::fprintf(stderr, "validation: %s\n", message.c_str());
    if (!messages.empty()) std::_Exit(3);
  }
};

}  // namespace

gpu::DeviceOptions device_options() {
  gpu::DeviceOptions options;
  if (const char* selector = std::getenv("SUREFIELD_DEVICE")) options.selector = selector;
  options.validate = true;
  return options;
}

gpu::Device& device() {
  static CheckedDevice checked(device_options());
  return checked.device;
}

gpu::Device& pool_device() {
  static CheckedDevice checked([] {
    gpu::DeviceOptions options = device_options();
    options.force_descriptor_pool = true;
    return options;
  }());
  return checked.device;
}

}  // namespace surefield::testing
