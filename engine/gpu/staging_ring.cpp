#include "engine/gpu/staging_ring.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <unordered_set>

#include "engine/gpu/barrier.h"
#include "engine/gpu/error.h"

namespace surefield::gpu {

namespace {

// Where pieces begin: threads that copy to and from neighbours share no cache line.
constexpr uint64_t kAlignment = 64;

uint64_t round_up(uint64_t value, uint64_t step) {
  return (value + step - 1) / step * step;
}

}  // namespace

StagingRing::StagingRing(Device& device, SubmissionQueue& queue, uint64_t bytes)
    : device_(device), queue_(queue), capacity_(round_up(std::max<uint64_t>(bytes, 1024), 4 * kAlignment)) {
  // Coherent: nothing is flushed by hand. Cached, since reading memory that is not is slow.
  const MemoryKind kind{
      .required = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
      .preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = device.queue_family();
  allocation_ = allocate(device, capacity_, kind, "the staging ring");
  void* mapped = nullptr;
  VkResult result = vkMapMemory(device.handle(), allocation_.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
  mapped_ = static_cast<std::byte*>(mapped);
  if (result == VK_SUCCESS) result = vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_);
  if (result != VK_SUCCESS) free_allocation(device, allocation_);
  check(result, "making the staging ring");
  ++device.live_counters().objects;
}

StagingRing::~StagingRing() {
  vkDestroyCommandPool(device_.handle(), pool_, nullptr);
  free_allocation(device_, allocation_);
}

void StagingRing::upload(const void* data, VkBuffer target, uint64_t offset, uint64_t bytes) {
  const auto* from = static_cast<const std::byte*>(data);
  device_.live_counters().bytes_uploaded += bytes;
  Lock lock(mutex_);
  for (uint64_t done = 0; done < bytes;) {
    const uint64_t piece = std::min(bytes - done, capacity_ / 4);
    const uint64_t place = take(lock, piece);
    std::memcpy(mapped_ + place, from + done, piece);
    uploads_.push_back({target, {place, offset + done, piece}});
    if (waiting_bytes() >= capacity_ / 2) submit(VK_NULL_HANDLE);
    done += piece;
  }
}

void StagingRing::download(void* data, VkBuffer source, uint64_t offset, uint64_t bytes) {
  auto* to = static_cast<std::byte*>(data);
  device_.live_counters().bytes_read_back += bytes;
  Lock lock(mutex_);
  for (uint64_t done = 0; done < bytes;) {
    const uint64_t piece = std::min(bytes - done, capacity_ / 4);
    read_piece(lock, to + done, source, offset + done, piece);
    done += piece;
  }
}

void StagingRing::read_piece(Lock& lock, void* data, VkBuffer source, uint64_t offset, uint64_t bytes) {
  const uint64_t place = take(lock, bytes);
  const Copy read{source, {offset, place, bytes}};
  const uint64_t submission = submit(VK_NULL_HANDLE, &read);
  Batch& batch = in_flight_.back();
  ++batch.readers;
  lock.unlock();
  const auto finish = [&] {
    lock.lock();
    --batch.readers;
    read_.notify_all();
  };
  try {
    queue_.wait(submission);
  } catch (...) {
    finish();
    throw;
  }
  std::memcpy(data, mapped_ + place, bytes);
  finish();
}

void StagingRing::submit_and_wait(VkCommandBuffer commands) {
  Lock lock(mutex_);
  const uint64_t submission = submit(commands);
  lock.unlock();
  queue_.wait(submission);
}

void StagingRing::finish_uploads() {
  Lock lock(mutex_);
  if (!uploads_.empty()) submit(VK_NULL_HANDLE);
  if (in_flight_.empty()) return;
  const uint64_t submission = in_flight_.back().submission;
  lock.unlock();
  queue_.wait(submission);
}

void StagingRing::forget(VkBuffer buffer) noexcept {
  Lock lock(mutex_);
  const auto concerns_it = [&](const Copy& copy) { return copy.buffer == buffer; };
  std::erase_if(uploads_, concerns_it);
  uint64_t last = 0;
  for (const Batch& batch : in_flight_)
    if (std::any_of(batch.uploads.begin(), batch.uploads.end(), concerns_it)) last = batch.submission;
  lock.unlock();
  try {
    queue_.wait(last);
  } catch (const Error&) {  // the device was lost, and the buffer with it
  }
}

/// The place in the ring of a piece of so many bytes, once there is room for it.
uint64_t StagingRing::take(Lock& lock, uint64_t bytes) {
  const uint64_t size = round_up(bytes, kAlignment);
  for (;;) {
    reclaim();
    if (in_flight_.empty() && uploads_.empty()) head_ = tail_ = 0;
    // A piece does not go over the end of the ring.
    const uint64_t begin = head_ % capacity_ + size > capacity_ ? round_up(head_, capacity_) : head_;
    if (begin + size - tail_ <= capacity_) {
      head_ = begin + size;
      return begin % capacity_;
    }
    make_room(lock);
  }
}

/// Waits for what fills the ring; unlocked meanwhile.
void StagingRing::make_room(Lock& lock) {
  if (!uploads_.empty()) submit(VK_NULL_HANDLE);
  const uint64_t oldest = in_flight_.front().submission;
  if (queue_.has_finished(oldest)) {
    // Somebody is copying a download, unless it has finished since the ring was last looked through.
    if (in_flight_.front().readers > 0) read_.wait(lock);
    return;
  }
  lock.unlock();
  queue_.wait(oldest);
  lock.lock();
}

/// Frees the part of the ring of which nothing is under way.
void StagingRing::reclaim() {
  while (!in_flight_.empty() && in_flight_.front().readers == 0 &&
         queue_.has_finished(in_flight_.front().submission)) {
    tail_ = in_flight_.front().end;
    free_commands_.push_back(in_flight_.front().commands);
    in_flight_.pop_front();
  }
}

/// What has been taken since the last submission of a batch.
uint64_t StagingRing::waiting_bytes() const {
  return head_ - (in_flight_.empty() ? tail_ : in_flight_.back().end);
}

/// Submits the uploads that wait, `read` behind them, and `commands` at last; returns the submission.
uint64_t StagingRing::submit(VkCommandBuffer commands, const Copy* read) {
  if (uploads_.empty() && !read) return queue_.submit({&commands, 1});
  const VkCommandBuffer both[] = {record(read), commands};
  const uint64_t submission = queue_.submit(std::span(both).first(commands ? 2 : 1));
  free_commands_.pop_back();
  in_flight_.push_back({both[0], submission, head_, std::move(uploads_)});
  uploads_.clear();
  return submission;
}

/// Records the copies into the last of free_commands_.
VkCommandBuffer StagingRing::record(const Copy* read) {
  const VkCommandBuffer commands = free_commands();
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &begin), "beginning a transfer");
  std::unordered_set<VkBuffer> written;
  for (const Copy& copy : uploads_) {
    if (!written.insert(copy.buffer).second) {
      record_full_barrier(commands);
      written = {copy.buffer};
    }
    vkCmdCopyBuffer(commands, allocation_.buffer, copy.buffer, 1, &copy.region);
  }
  if (read) {
    if (!uploads_.empty()) record_full_barrier(commands);
    vkCmdCopyBuffer(commands, read->buffer, allocation_.buffer, 1, &read->region);
  }
  record_full_barrier(commands);
  check(vkEndCommandBuffer(commands), "ending a transfer");
  return commands;
}

/// A command buffer that is not in flight; it stays in free_commands_, as the last.
VkCommandBuffer StagingRing::free_commands() {
  if (free_commands_.empty()) {
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = pool_;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device_.handle(), &info, &commands), "allocating a command buffer");
    free_commands_.push_back(commands);
  }
  return free_commands_.back();
}

}  // namespace surefield::gpu
