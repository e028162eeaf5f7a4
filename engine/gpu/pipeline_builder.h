#pragma once

#include <vulkan/vulkan.h>

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

namespace surefield::gpu {

/// Builds a device's pipelines on all cores, in the order that they are asked for, and keeps what the driver
/// has compiled in a file, so that it need not be compiled again by the next run.
class PipelineBuilder {
 public:
  /// Reads `file`, if there is one that fits; an empty path: nothing is kept.
  PipelineBuilder(VkPhysicalDevice physical, VkDevice device, std::filesystem::path file);
  /// Waits, and writes the file if there is anything new. That it cannot be written is no error.
  ~PipelineBuilder();
  PipelineBuilder(const PipelineBuilder&) = delete;

  /// Has `build` called from another thread; the future gets what it returns or throws.
  std::shared_future<VkPipeline> build(std::function<VkPipeline(VkPipelineCache)> build);

  /// Waits until everything has been built.
  void wait();

 private:
  void work();
  void save();

  VkDevice device_;
  std::filesystem::path file_;
  std::vector<uint8_t> loaded_;  ///< what the file held
  VkPipelineCache cache_ = VK_NULL_HANDLE;

  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::deque<std::packaged_task<VkPipeline()>> queue_;
  int busy_ = 0;  ///< workers that build
  bool stopped_ = false;
  std::vector<std::thread> workers_;  ///< as many as there was work for
};

}  // namespace surefield::gpu
