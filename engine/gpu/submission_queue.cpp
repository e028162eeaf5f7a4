#include "engine/gpu/submission_queue.h"

#include <vector>

#include "engine/gpu/error.h"

namespace surefield::gpu {

SubmissionQueue::SubmissionQueue(VkDevice device, VkQueue queue, LiveCounters& counters)
    : device_(device), queue_(queue), counters_(counters) {
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type};
  check(vkCreateSemaphore(device_, &info, nullptr, &timeline_), "creating a semaphore");
  ++counters_.objects;
}

SubmissionQueue::~SubmissionQueue() {
  vkDestroySemaphore(device_, timeline_, nullptr);
}

uint64_t SubmissionQueue::submit(std::span<const VkCommandBuffer> commands) {
  std::vector<VkCommandBufferSubmitInfo> buffers;
  for (VkCommandBuffer buffer : commands) {
    buffers.push_back({VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO});
    buffers.back().commandBuffer = buffer;
  }
  VkSemaphoreSubmitInfo done{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
  done.semaphore = timeline_;
  done.value = submitted_ + 1;
  done.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.commandBufferInfoCount = static_cast<uint32_t>(buffers.size());
  submit.pCommandBufferInfos = buffers.data();
  submit.signalSemaphoreInfoCount = 1;
  submit.pSignalSemaphoreInfos = &done;
  check(vkQueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE), "running kernels");
  ++counters_.submissions;
  return ++submitted_;
}

void SubmissionQueue::note_finished(uint64_t submission) {
  uint64_t known = finished_;
  while (submission > known && !finished_.compare_exchange_weak(known, submission)) {
  }
}

bool SubmissionQueue::has_finished(uint64_t submission) {
  if (submission <= finished_) return true;
  uint64_t now = 0;
  check(vkGetSemaphoreCounterValue(device_, timeline_, &now), "running kernels");
  note_finished(now);
  return submission <= now;
}

void SubmissionQueue::wait(uint64_t submission) {
  if (submission <= finished_) return;
  VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  info.semaphoreCount = 1;
  info.pSemaphores = &timeline_;
  info.pValues = &submission;
  check(vkWaitSemaphores(device_, &info, UINT64_MAX), "running kernels");
  note_finished(submission);
}

}  // namespace surefield::gpu
