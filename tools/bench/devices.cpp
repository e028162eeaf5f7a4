// surefield devices: what the machine offers to run on.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/gpu/device.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr const char* kDevicesExamples =
    "Examples:\n"
    "  surefield devices\n"
    "  surefield run --device 1 ...        # by the number in the list, or by a part of the name\n";

int list() {
  const auto devices = gpu::list_devices();
  for (const gpu::DeviceReport& device : devices) {
    const std::string state =
        device.missing.empty() ? "usable" : fmt::format("lacks {}", fmt::join(device.missing, ", "));
    fmt::print("{}  {}\n", device.index, device.name);
    fmt::print("   type      {}\n", device.type);
    fmt::print("   driver    {}\n", device.driver);
    fmt::print("   Vulkan    {}.{}\n", device.api_major, device.api_minor);
    fmt::print("   subgroup  {} lanes\n", device.subgroup_size);
    fmt::print("   memory    {:.1f} GiB\n", static_cast<double>(device.memory_bytes) / (1 << 30));
    fmt::print("   state     {}\n", state);
  }
  if (!devices.empty()) return kSuccess;
  print_error("no Vulkan device; install a driver (mesa-vulkan-drivers has one for the CPU)");
  return kDeviceError;
}

}  // namespace

void add_devices(CLI::App& program, Action& action) {
  CLI::App* devices = program.add_subcommand(
      "devices", "Lists the Vulkan devices of this machine and what each of them lacks");
  devices->footer(kDevicesExamples);
  devices->callback([&action] { action = list; });
}

}  // namespace surefield
