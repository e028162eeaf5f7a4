#pragma once

#include <vulkan/vulkan.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/gpu/live_counters.h"

namespace surefield::gpu {

/// How to choose and open a device.
struct DeviceOptions {
  /// Index or part of a name, as `surefield devices` prints them. Empty: the first discrete GPU, else an
  /// integrated one, else any other, CPU last.
  std::string selector;
  /// Turn on the Khronos validation layer with synchronisation validation; its messages are collected.
  bool validate = false;
  /// Bind with descriptor sets from a pool even where the device has push descriptors (for tests of that
  /// fallback).
  bool force_descriptor_pool = false;
  /// Where what the driver compiles is kept between runs. Empty: user_cache_folder().
  std::filesystem::path cache_folder;
  /// Host memory that uploads and downloads go through; larger ones go in pieces. Tests make it small.
  uint64_t staging_bytes = 16 << 20;
  /// Instance extensions that windows need. Not empty: the queue also draws, and the device can have a
  /// swapchain; see WindowHandles.
  std::vector<std::string> window_extensions;
};

/// What `surefield devices` prints about one device.
struct DeviceReport {
  uint32_t index = 0;
  std::string name;
  std::string type;    ///< "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other"
  std::string driver;  ///< driver name and version
  uint32_t api_major = 0, api_minor = 0;
  uint32_t subgroup_size = 0;
  uint64_t memory_bytes = 0;         ///< size of the largest device-local heap
  std::vector<std::string> missing;  ///< required features that the device lacks; empty: usable
};

/// All Vulkan devices of this machine, in the loader's order. Throws Error(NoDevice) when there is no Vulkan
/// at all.
std::vector<DeviceReport> list_devices();

/// The limits that shape kernels and buffers.
struct DeviceLimits {
  uint32_t subgroup_size = 0;          ///< every pipeline is created for this size
  uint32_t workgroup_invocations = 0;  ///< largest workgroup
  uint32_t workgroups_x = 0;           ///< largest dispatch in x
  uint32_t workgroups_y = 0;           ///< largest dispatch in y
  uint32_t shared_memory_bytes = 0;
  uint64_t storage_range_bytes = 0;  ///< largest storage-buffer binding
  uint64_t storage_offset_alignment = 0;
  double timestamp_ns = 0;  ///< nanoseconds per timestamp tick; 0: no timestamps
  bool push_descriptors = false;
  bool require_subgroup_size = false;  ///< the device has several sizes: pipelines must ask for subgroup_size
  bool is_cpu = false;                 ///< a software implementation
};

class PipelineBuilder;
class RecordingPool;
class StagingRing;
class SubmissionQueue;

/// What a window needs of a device that was opened with window extensions, to present pictures with.
struct WindowHandles {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;  ///< no other thread may submit, upload or download while the window uses
                                   ///< it; uploads since the last submission are not there yet
  uint32_t queue_family = 0;
};

/// Device time of one recorded dispatch.
struct PassTime {
  const char* pass;
  double milliseconds;
};

/// An open Vulkan device with one compute queue. Several threads may use it: submission, staging memory and
/// the objects that recorders take are guarded. A buffer, a pass or a recorder is used by one thread at a
/// time.
class Device {
 public:
  /// Opens the device that `options` select. Throws Error(NoDevice) or Error(MissingFeature).
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceReport& report() const { return report_; }
  const DeviceLimits& limits() const { return limits_; }
  VkDevice handle() const { return device_; }
  WindowHandles window_handles() const { return {instance_, physical_, device_, queue_, queue_family_}; }
  uint32_t queue_family() const { return queue_family_; }
  PFN_vkCmdPushDescriptorSetKHR push_descriptor_set() const { return push_descriptor_set_; }

  /// Submits a command buffer, behind all uploads so far, and waits until it has finished.
  void submit_and_wait(VkCommandBuffer commands);
  /// Waits until all uploads so far have reached their buffers; else they do so with the next submission.
  void finish_uploads();

  /// What uploads and downloads of buffers go through, and what recorders record with.
  StagingRing& staging() { return *staging_; }
  RecordingPool& recordings() { return *recordings_; }

  /// Has a pipeline built by another thread: `build` is called with the cache to build it with.
  std::shared_future<VkPipeline> build_pipeline(std::function<VkPipeline(VkPipelineCache)> build);
  /// Waits until all pipelines have been built, so that none is waited for later.
  void finish_pipelines();

  /// Index of a memory type among `type_bits` with all of `flags`, and of `preferred` if there is one. Throws
  /// Error(MissingFeature).
  uint32_t memory_type(uint32_t type_bits, VkMemoryPropertyFlags flags,
                       VkMemoryPropertyFlags preferred = 0) const;

  /// What was done since the device was opened, by all threads together.
  DeviceCounters counters() const { return live_counters_.read(); }
  /// Called by what does it.
  LiveCounters& live_counters() { return live_counters_; }

  /// Accounting of device memory, called by Buffer.
  void count_memory(int64_t bytes);
  uint64_t memory_in_use() const { return memory_in_use_; }
  uint64_t memory_peak() const { return memory_peak_; }

  /// While on, every dispatch of every recorder is timed, which slows submissions down; take_pass_times()
  /// returns the times since the last call.
  void time_passes(bool on) { times_passes_ = on; }
  bool times_passes() const { return times_passes_; }
  std::vector<PassTime> take_pass_times();
  /// Called by Recorder.
  void add_pass_times(const std::vector<PassTime>& times);

  /// Messages of the validation layer so far (only with DeviceOptions::validate).
  std::vector<std::string> validation_messages() const;

 private:
  void create_logical_device(bool with_swapchain);
  void create_pipeline_builder(const std::filesystem::path& cache_folder);
  void create_submission(uint64_t staging_bytes);
  void destroy();

  struct Validation;
  std::unique_ptr<Validation> validation_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queue_family_ = 0;
  PFN_vkCmdPushDescriptorSetKHR push_descriptor_set_ = nullptr;
  VkPhysicalDeviceMemoryProperties memory_{};
  std::unique_ptr<PipelineBuilder> pipeline_builder_;
  LiveCounters live_counters_;
  std::unique_ptr<SubmissionQueue> submissions_;
  std::unique_ptr<StagingRing> staging_;
  std::unique_ptr<RecordingPool> recordings_;
  DeviceReport report_;
  DeviceLimits limits_;
  std::atomic<bool> times_passes_{false};
  std::mutex pass_times_mutex_;
  std::vector<PassTime> pass_times_;
  std::atomic<uint64_t> memory_in_use_{0};
  std::atomic<uint64_t> memory_peak_{0};
};

}  // namespace surefield::gpu
