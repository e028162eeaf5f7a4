#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <vector>

#include "engine/gpu/allocation.h"
#include "engine/gpu/submission_queue.h"

namespace surefield::gpu {

/// The memory that all transfers of a device go through: allocated and mapped once, and used round and round.
///
/// An upload is copied into the ring and waits there: the copies into buffers go to the device ahead of the
/// next commands of anybody, in the same submission, so that an upload costs no submission of its own and
/// nobody waits for it. Where half of the ring waits, the copies go at once, and the device works on them
/// while the other half is filled. A download takes a submission, behind the uploads before it, and is waited
/// for. What is larger than a quarter of the ring goes in pieces.
///
/// Threads: all methods may be called by several threads at once. One mutex guards the ring and, since every
/// submission goes through here, the queue; it is held while memory is copied into the ring, never while the
/// device is waited for. What one thread has uploaded when another submits is there for that submission; two
/// threads that use one buffer agree among themselves on who goes first.
class StagingRing {
 public:
  /// A ring of `bytes`, at least 1024. Throws Error.
  StagingRing(Device& device, SubmissionQueue& queue, uint64_t bytes);
  /// Uploads that were not submitted are dropped. The device must have finished what was.
  ~StagingRing();
  StagingRing(const StagingRing&) = delete;

  /// Copies host memory into a buffer, ahead of all commands that are submitted from here on. Throws Error.
  void upload(const void* data, VkBuffer target, uint64_t offset, uint64_t bytes);
  /// Copies from a buffer into host memory, after all that was submitted or uploaded before. Throws Error.
  void download(void* data, VkBuffer source, uint64_t offset, uint64_t bytes);

  /// Submits the uploads that wait, and these commands behind them; waits until they have finished. Throws
  /// Error.
  void submit_and_wait(VkCommandBuffer commands);
  /// Submits the uploads that wait, and waits until all uploads have finished. Throws Error.
  void finish_uploads();

  /// Drops the uploads to a buffer that wait, and waits for those under way: it can then be destroyed.
  void forget(VkBuffer buffer) noexcept;

 private:
  /// Between the ring and a buffer.
  struct Copy {
    VkBuffer buffer;
    VkBufferCopy region;
  };
  /// Copies that were submitted together.
  struct Batch {
    VkCommandBuffer commands;
    uint64_t submission;
    uint64_t end;  ///< of its part of the ring, which begins where that of the batch before ends
    std::vector<Copy> uploads;
    int readers = 0;  ///< downloads that are still to be copied out of the ring
  };
  using Lock = std::unique_lock<std::mutex>;

  uint64_t take(Lock& lock, uint64_t bytes);
  void make_room(Lock& lock);
  void reclaim();
  uint64_t waiting_bytes() const;
  uint64_t submit(VkCommandBuffer commands, const Copy* read = nullptr);
  VkCommandBuffer record(const Copy* read);
  VkCommandBuffer free_commands();
  void read_piece(Lock& lock, void* data, VkBuffer source, uint64_t offset, uint64_t bytes);

  Device& device_;
  SubmissionQueue& queue_;
  const uint64_t capacity_;
  Allocation allocation_;
  std::byte* mapped_ = nullptr;
  VkCommandPool pool_ = VK_NULL_HANDLE;

  std::mutex mutex_;
  std::condition_variable read_;  ///< a download has been copied out
  // Positions in the ring count on over its end: what lies from tail_ to head_ is in use.
  uint64_t head_ = 0;
  uint64_t tail_ = 0;
  std::vector<Copy> uploads_;    ///< that wait
  std::deque<Batch> in_flight_;  ///< in the order of submission; references to batches stay good
  std::vector<VkCommandBuffer> free_commands_;
};

}  // namespace surefield::gpu
