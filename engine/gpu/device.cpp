#include "engine/gpu/device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "engine/gpu/device_report.h"
#include "engine/gpu/error.h"
#include "engine/gpu/pipeline_builder.h"
#include "engine/gpu/pipeline_file.h"
#include "engine/gpu/recording_pool.h"
#include "engine/gpu/staging_ring.h"
#include "engine/gpu/submission_queue.h"

namespace surefield::gpu {

struct Device::Validation {
  std::mutex mutex;
  std::vector<std::string> messages;
  std::function<void(const char*)> sink;  ///< what the layer calls
};

namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL collect_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                               VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto& add = *static_cast<std::function<void(const char*)>*>(user);
  add(data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerEXT create_messenger(VkInstance instance, std::function<void(const char*)>* sink) {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = collect_message;
  info.pUserData = sink;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  check(create(instance, &info, nullptr, &messenger), "creating the validation messenger");
  return messenger;
}

DeviceLimits read_limits(VkPhysicalDevice physical, const DeviceReport& report) {
  VkPhysicalDeviceVulkan13Properties v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v13};
  vkGetPhysicalDeviceProperties2(physical, &all);
  const VkPhysicalDeviceProperties& properties = all.properties;
  DeviceLimits limits;
  limits.subgroup_size = report.subgroup_size;
  limits.require_subgroup_size = v13.minSubgroupSize != v13.maxSubgroupSize &&
                                 (v13.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT);
  limits.workgroup_invocations = properties.limits.maxComputeWorkGroupInvocations;
  limits.workgroups_x = properties.limits.maxComputeWorkGroupCount[0];
  limits.workgroups_y = properties.limits.maxComputeWorkGroupCount[1];
  limits.shared_memory_bytes = properties.limits.maxComputeSharedMemorySize;
  limits.storage_range_bytes = properties.limits.maxStorageBufferRange;
  limits.storage_offset_alignment = properties.limits.minStorageBufferOffsetAlignment;
  limits.timestamp_ns = properties.limits.timestampComputeAndGraphics ? properties.limits.timestampPeriod : 0;
  limits.is_cpu = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  return limits;
}

}  // namespace

Device::Device(const DeviceOptions& options) {
  const bool with_window = !options.window_extensions.empty();
  instance_ = create_instance(options.validate, options.window_extensions);
  try {
    if (options.validate) {
      validation_ = std::make_unique<Validation>();
      validation_->sink = [v = validation_.get()](const char* message) {
        std::lock_guard lock(v->mutex);
        v->messages.push_back(message);
      };
      messenger_ = create_messenger(instance_, &validation_->sink);
    }
    const auto devices = physical_devices(instance_);
    std::vector<DeviceReport> reports;
    for (std::size_t i = 0; i < devices.size(); ++i)
      reports.push_back(describe(devices[i], static_cast<uint32_t>(i)));
    const std::size_t chosen = select_device(reports, options.selector);
    physical_ = devices[chosen];
    report_ = reports[chosen];
    if (!report_.missing.empty())
      throw Error(Error::Kind::MissingFeature,
                  fmt::format("{} lacks {}: update its driver or choose another --device", report_.name,
                              fmt::join(report_.missing, ", ")));
    limits_ = read_limits(physical_, report_);
    limits_.push_descriptors =
        !options.force_descriptor_pool && has_extension(physical_, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
    queue_family_ = compute_queue_family(physical_, with_window);
    if (with_window &&
        (queue_family_ == UINT32_MAX || !has_extension(physical_, VK_KHR_SWAPCHAIN_EXTENSION_NAME)))
      throw Error(Error::Kind::MissingFeature,
                  fmt::format("{} cannot show windows: choose another --device", report_.name));
    create_logical_device(with_window);
    create_pipeline_builder(options.cache_folder);
    create_submission(options.staging_bytes);
  } catch (...) {
    destroy();
    throw;
  }
}

Device::~Device() {
  destroy();
}

void Device::destroy() {
  pipeline_builder_.reset();
  if (device_) vkDeviceWaitIdle(device_);
  recordings_.reset();
  staging_.reset();
  submissions_.reset();
  if (device_) vkDestroyDevice(device_, nullptr);
  if (messenger_) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  vkDestroyInstance(instance_, nullptr);
}

void Device::create_logical_device(bool with_swapchain) {
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;

  FeatureChain features;
  features.v12.scalarBlockLayout = VK_TRUE;
  features.v12.timelineSemaphore = VK_TRUE;
  features.v13.synchronization2 = VK_TRUE;
  features.v13.subgroupSizeControl = VK_TRUE;
  features.v13.computeFullSubgroups = VK_TRUE;
  features.v13.maintenance4 = VK_TRUE;  // workgroup sizes from specialisation constants

  std::vector<const char*> extensions;
  if (limits_.push_descriptors) extensions.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
  if (with_swapchain) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateDevice(physical_, &info, nullptr, &device_), "creating the Vulkan device");
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  if (limits_.push_descriptors)
    push_descriptor_set_ = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
        vkGetDeviceProcAddr(device_, "vkCmdPushDescriptorSetKHR"));
}

void Device::create_pipeline_builder(const std::filesystem::path& cache_folder) {
  std::filesystem::path file = cache_folder.empty() ? user_cache_folder() : cache_folder;
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical_, &properties);
  if (!file.empty()) file /= pipeline_file_name(properties);
  pipeline_builder_ = std::make_unique<PipelineBuilder>(physical_, device_, file);
}

std::shared_future<VkPipeline> Device::build_pipeline(std::function<VkPipeline(VkPipelineCache)> build) {
  return pipeline_builder_->build(std::move(build));
}

void Device::finish_pipelines() {
  pipeline_builder_->wait();
}

void Device::create_submission(uint64_t staging_bytes) {
  submissions_ = std::make_unique<SubmissionQueue>(device_, queue_, live_counters_);
  staging_ = std::make_unique<StagingRing>(*this, *submissions_, staging_bytes);
  recordings_ = std::make_unique<RecordingPool>(device_, queue_family_, live_counters_);
}

void Device::submit_and_wait(VkCommandBuffer commands) {
  staging_->submit_and_wait(commands);
}

void Device::finish_uploads() {
  staging_->finish_uploads();
}

uint32_t Device::memory_type(uint32_t type_bits, VkMemoryPropertyFlags flags,
                             VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags wanted : {flags | preferred, flags})
    for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
      if ((type_bits & (1u << i)) && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  throw Error(Error::Kind::MissingFeature, "the device has no memory of the kind that buffers need");
}

void Device::count_memory(int64_t bytes) {
  const uint64_t now = memory_in_use_ += static_cast<uint64_t>(bytes);
  uint64_t peak = memory_peak_;
  while (now > peak && !memory_peak_.compare_exchange_weak(peak, now)) {
  }
}

std::vector<PassTime> Device::take_pass_times() {
  std::lock_guard lock(pass_times_mutex_);
  return std::exchange(pass_times_, {});
}

void Device::add_pass_times(const std::vector<PassTime>& times) {
  std::lock_guard lock(pass_times_mutex_);
  pass_times_.insert(pass_times_.end(), times.begin(), times.end());
}

std::vector<std::string> Device::validation_messages() const {
  if (!validation_) return {};
  std::lock_guard lock(validation_->mutex);
  return validation_->messages;
}

}  // namespace surefield::gpu
