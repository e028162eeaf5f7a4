#pragma once

#include "engine/gpu/device.h"

namespace surefield::gpu {

/// The chain of features that the engine asks for (all of them Vulkan 1.3 core).
struct FeatureChain {
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
  VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
  FeatureChain() = default;
  FeatureChain(const FeatureChain&) = delete;
};

/// Creates an instance with these extensions; with `validate`, the Khronos layer with synchronisation
/// validation.
VkInstance create_instance(bool validate, const std::vector<std::string>& extensions = {});

/// The physical devices of an instance, in the loader's order.
std::vector<VkPhysicalDevice> physical_devices(VkInstance instance);

/// Describes one device and what it lacks.
DeviceReport describe(VkPhysicalDevice device, uint32_t index);

/// Whether the device offers an extension.
bool has_extension(VkPhysicalDevice device, const char* name);

/// The first queue family with compute, and graphics where that is asked for; or UINT32_MAX.
uint32_t compute_queue_family(VkPhysicalDevice device, bool with_graphics = false);

/// Index into `reports` of the device that `selector` names (DeviceOptions::selector). Throws
/// Error(NoDevice).
std::size_t select_device(const std::vector<DeviceReport>& reports, const std::string& selector);

}  // namespace surefield::gpu
