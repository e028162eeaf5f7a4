#include "engine/gpu/pipeline_builder.h"

#include <algorithm>
#include <utility>

#include "engine/gpu/pipeline_file.h"

namespace surefield::gpu {

namespace {

VkPipelineCache create_cache(VkDevice device, const std::vector<uint8_t>& data) {
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  info.initialDataSize = data.size();
  info.pInitialData = data.data();
  VkPipelineCache cache = VK_NULL_HANDLE;
  if (vkCreatePipelineCache(device, &info, nullptr, &cache) == VK_SUCCESS) return cache;
  return VK_NULL_HANDLE;  // pipelines can be built without
}

}  // namespace

PipelineBuilder::PipelineBuilder(VkPhysicalDevice physical, VkDevice device, std::filesystem::path file)
    : device_(device), file_(std::move(file)) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical, &properties);
  if (!file_.empty()) loaded_ = read_pipeline_file(file_, properties);
  cache_ = create_cache(device, loaded_);
  if (!cache_) cache_ = create_cache(device, {});
}

PipelineBuilder::~PipelineBuilder() {
  wait();
  {
    std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  if (!file_.empty() && cache_) save();
  vkDestroyPipelineCache(device_, cache_, nullptr);
}

std::shared_future<VkPipeline> PipelineBuilder::build(std::function<VkPipeline(VkPipelineCache)> build) {
  std::packaged_task<VkPipeline()> task([this, build = std::move(build)] { return build(cache_); });
  std::shared_future<VkPipeline> future = task.get_future().share();
  {
    std::lock_guard lock(mutex_);
    queue_.push_back(std::move(task));
    const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
    if (workers_.size() < most && workers_.size() < queue_.size() + static_cast<std::size_t>(busy_))
      workers_.emplace_back([this] { work(); });
  }
  changed_.notify_all();
  return future;
}

void PipelineBuilder::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return queue_.empty() && busy_ == 0; });
}

void PipelineBuilder::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stopped_ || !queue_.empty(); });
    if (queue_.empty()) return;
    std::packaged_task<VkPipeline()> task = std::move(queue_.front());
    queue_.pop_front();
    ++busy_;
    lock.unlock();
    task();
    lock.lock();
    --busy_;
    changed_.notify_all();
  }
}

void PipelineBuilder::save() {
  std::size_t bytes = 0;
  if (vkGetPipelineCacheData(device_, cache_, &bytes, nullptr) != VK_SUCCESS) return;
  std::vector<uint8_t> data(bytes);
  if (vkGetPipelineCacheData(device_, cache_, &bytes, data.data()) != VK_SUCCESS) return;
  data.resize(bytes);
  if (data != loaded_) write_pipeline_file(file_, data);
}

}  // namespace surefield::gpu
