#include "engine/gpu/device_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "engine/gpu/error.h"

namespace surefield::gpu {

namespace {

// What the kernels need beyond the least that Vulkan promises.
constexpr uint32_t kStorageBuffers = 17;
constexpr uint32_t kWorkgroupInvocations = 256;
constexpr uint32_t kSharedMemoryBytes = 32768;

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

std::vector<std::string> missing_features(VkPhysicalDevice device,
                                          const VkPhysicalDeviceProperties& properties,
                                          const VkPhysicalDeviceSubgroupProperties& subgroup) {
  std::vector<std::string> missing;
  if (properties.apiVersion < VK_API_VERSION_1_3) {
    missing.push_back("Vulkan 1.3");
    return missing;
  }
  FeatureChain features;
  vkGetPhysicalDeviceFeatures2(device, &features.core);
  if (!features.v12.scalarBlockLayout) missing.push_back("scalarBlockLayout");
  if (!features.v12.timelineSemaphore) missing.push_back("timelineSemaphore");
  if (!features.v13.synchronization2) missing.push_back("synchronization2");
  if (!features.v13.maintenance4) missing.push_back("maintenance4");
  if (!features.v13.subgroupSizeControl) missing.push_back("subgroupSizeControl");
  if (!features.v13.computeFullSubgroups) missing.push_back("computeFullSubgroups");
  const VkSubgroupFeatureFlags needed =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  if ((subgroup.supportedOperations & needed) != needed ||
      !(subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT))
    missing.push_back("subgroup vote and shuffle in compute shaders");
  if (subgroup.subgroupSize < 4 || subgroup.subgroupSize > 64)
    missing.push_back("a subgroup size of 4 to 64");
  const VkPhysicalDeviceLimits& limits = properties.limits;
  if (limits.maxPerStageDescriptorStorageBuffers < kStorageBuffers)
    missing.push_back(fmt::format("{} storage buffers in a shader", kStorageBuffers));
  if (limits.maxComputeWorkGroupInvocations < kWorkgroupInvocations)
    missing.push_back(fmt::format("workgroups of {}", kWorkgroupInvocations));
  if (limits.maxComputeSharedMemorySize < kSharedMemoryBytes)
    missing.push_back(fmt::format("{} bytes of shared memory", kSharedMemoryBytes));
  if (compute_queue_family(device) == UINT32_MAX) missing.push_back("a compute queue");
  return missing;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Default order of preference; smaller is better.
int preference(const DeviceReport& report) {
  if (!report.missing.empty()) return 9;
  if (report.type == "discrete GPU") return 0;
  if (report.type == "integrated GPU") return 1;
  return report.type == "CPU" ? 3 : 2;
}

}  // namespace

VkInstance create_instance(bool validate, const std::vector<std::string>& extensions) {
  const VkApplicationInfo application{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "surefield", 1, "surefield", 1, VK_API_VERSION_1_3};
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  const char* layer = "VK_LAYER_KHRONOS_validation";
  std::vector<const char*> names;
  for (const std::string& extension : extensions) names.push_back(extension.c_str());
  const VkValidationFeatureEnableEXT enabled[] = {
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = enabled;
  if (validate) {
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &layer;
    names.insert(names.end(), {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME});
    info.pNext = &features;
  }
  info.enabledExtensionCount = static_cast<uint32_t>(names.size());
  info.ppEnabledExtensionNames = names.data();
  VkInstance instance = VK_NULL_HANDLE;
  const VkResult result = vkCreateInstance(&info, nullptr, &instance);
  if (result == VK_ERROR_LAYER_NOT_PRESENT || result == VK_ERROR_EXTENSION_NOT_PRESENT)
    throw Error(Error::Kind::MissingFeature,
                "--validate needs the Khronos validation layer: install vulkan-validationlayers");
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw Error(Error::Kind::NoDevice, "no Vulkan driver found: install mesa-vulkan-drivers (a CPU will do)");
  check(result, "creating the Vulkan instance");
  return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
  uint32_t count = 0;
  const VkResult result = vkEnumeratePhysicalDevices(instance, &count, nullptr);
  if (result == VK_ERROR_INITIALIZATION_FAILED) return {};
  check(result, "listing the Vulkan devices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "listing the Vulkan devices");
  devices.resize(count);
  return devices;
}

bool has_extension(VkPhysicalDevice device, const char* name) {
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

uint32_t compute_queue_family(VkPhysicalDevice device, bool with_graphics) {
  const VkQueueFlags needed = VK_QUEUE_COMPUTE_BIT | (with_graphics ? VK_QUEUE_GRAPHICS_BIT : 0);
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  for (uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & needed) == needed) return i;
  return UINT32_MAX;
}

DeviceReport describe(VkPhysicalDevice device, uint32_t index) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, &driver};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroup};
  vkGetPhysicalDeviceProperties2(device, &properties);
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(device, &memory);

  DeviceReport report;
  report.index = index;
  report.name = properties.properties.deviceName;
  report.type = type_name(properties.properties.deviceType);
  report.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  report.api_major = VK_API_VERSION_MAJOR(properties.properties.apiVersion);
  report.api_minor = VK_API_VERSION_MINOR(properties.properties.apiVersion);
  report.subgroup_size = subgroup.subgroupSize;
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      report.memory_bytes = std::max<uint64_t>(report.memory_bytes, memory.memoryHeaps[i].size);
  report.missing = missing_features(device, properties.properties, subgroup);
  return report;
}

std::vector<DeviceReport> list_devices() {
  VkInstance instance = create_instance(false);
  std::vector<DeviceReport> reports;
  for (VkPhysicalDevice device : physical_devices(instance))
    reports.push_back(describe(device, static_cast<uint32_t>(reports.size())));
  vkDestroyInstance(instance, nullptr);
  return reports;
}

std::size_t select_device(const std::vector<DeviceReport>& reports, const std::string& selector) {
  if (reports.empty())
    throw Error(Error::Kind::NoDevice, "no Vulkan device found: install mesa-vulkan-drivers (a CPU will do)");
  if (selector.empty()) {
    const auto best = std::min_element(reports.begin(), reports.end(), [](const auto& a, const auto& b) {
      return preference(a) < preference(b);
    });
    return static_cast<std::size_t>(best - reports.begin());
  }
  const bool is_index = selector.size() < 4 && std::all_of(selector.begin(), selector.end(), ::isdigit);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (is_index ? std::to_string(i) == selector
                 : lower(reports[i].name).find(lower(selector)) != std::string::npos)
      return i;
  }
  throw Error(Error::Kind::NoDevice,
              fmt::format("no Vulkan device matches --device {}: `surefield devices` lists them", selector));
}

}  // namespace surefield::gpu
