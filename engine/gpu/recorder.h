#pragma once

#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "engine/gpu/pass.h"
#include "engine/gpu/recording_pool.h"

namespace surefield::gpu {

/// Arguments of an indirect dispatch, as a pass writes them: workgroups in x, y, z.
using DispatchArgs = glsl::uvec3;

/// Records passes, fills and copies into one command buffer and submits it. A memory barrier is put in
/// wherever a pass touches what an earlier one wrote, or writes what an earlier one read, as their binding
/// tables tell.
class Recorder {
 public:
  explicit Recorder(Device& device);
  ~Recorder();
  Recorder(const Recorder&) = delete;

  /// Times every later dispatch of this recorder; submit() then returns the times. Device::time_passes() does
  /// so for all recorders.
  void enable_timestamps(uint32_t capacity = 4096);

  /// Dispatches `groups_x` x `groups_y` workgroups. Zero groups record nothing.
  template <class P>
  void dispatch(const Pass<P>& pass, uint32_t groups_x, uint32_t groups_y,
                const typename P::Bindings& bindings, const typename P::Params& params) {
    if (groups_x == 0 || groups_y == 0) return;
    const auto slices = P::slices(bindings);
    prepare(pass, slices, &params, nullptr);
    run(pass, groups_x, groups_y);
  }
  template <class P>
  void dispatch(const Pass<P>& pass, uint32_t groups, const typename P::Bindings& bindings,
                const typename P::Params& params) {
    dispatch(pass, groups, 1, bindings, params);
  }

  /// Dispatches as many workgroups as entry `index` of `args` says when the device gets there.
  template <class P>
  void dispatch_indirect(const Pass<P>& pass, const Array<DispatchArgs>& args, uint32_t index,
                         const typename P::Bindings& bindings, const typename P::Params& params) {
    const auto slices = P::slices(bindings);
    const Slice group_counts{&args.buffer(), index * sizeof(DispatchArgs), sizeof(DispatchArgs)};
    check_range(group_counts, "dispatching indirectly");
    prepare(pass, slices, &params, &args.buffer());
    run_indirect(pass, group_counts);
  }

  /// Sets every 32-bit word of a range to `value`.
  void fill(const Slice& range, uint32_t value);
  template <class T>
  void fill(const Array<T>& array, uint64_t count, uint32_t value) {
    if (count) fill({&array.buffer(), 0, count * sizeof(T)}, value);
  }

  /// Copies `source.bytes` bytes.
  void copy(const Slice& source, const Slice& target);

  /// Grows `array` to at least `count` entries while work is being recorded; the contents are lost. What was
  /// recorded before goes on using the old memory, which lives until it has been submitted.
  template <class T>
  void reserve(Array<T>& array, uint64_t count) {
    if (count <= array.capacity()) return;
    const uint64_t bytes = array.buffer().grown_bytes(count * sizeof(T));
    replace(array, Array<T>(device_, array.buffer().name(), std::max<uint64_t>(count, bytes / sizeof(T))));
  }

  /// Puts `successor` in the place of `array`; what was recorded before goes on using the old memory.
  template <class T>
  void replace(Array<T>& array, Array<T> successor) {
    std::swap(array, successor);
    retired_.push_back(std::move(successor.buffer()));
  }

  /// Copies between raw handles, of which nothing is tracked: no barrier is put in.
  void copy_raw(VkBuffer source, uint64_t source_offset, VkBuffer target, uint64_t target_offset,
                uint64_t bytes);

  /// Submits everything recorded and waits. Returns the times of the dispatches if timestamps are on. The
  /// recorder is empty afterwards and can be used again.
  std::vector<PassTime> submit();

 private:
  void begin();
  void prepare(const Pipeline& pass, std::span<const Slice> slices, const void* params,
               const Buffer* indirect);
  void bind(const Pipeline& pass, std::span<const Slice> slices);
  VkDescriptorSet allocate_set(VkDescriptorSetLayout layout);
  void run(const Pipeline& pass, uint32_t groups_x, uint32_t groups_y);
  void run_indirect(const Pipeline& pass, const Slice& group_counts);
  static void check_range(const Slice& range, const char* doing);
  void timestamp(const char* pass);
  void touch(std::span<const VkBuffer> reads, std::span<const VkBuffer> writes);
  std::vector<PassTime> read_times();

  Device& device_;
  RecordingObjects& objects_;             ///< the device's
  VkCommandBuffer commands_;              ///< of these
  std::size_t pools_full_ = 0;            ///< descriptor pools, from the first on, that have no set left
  std::unordered_set<VkBuffer> read_;     ///< read since the last barrier
  std::unordered_set<VkBuffer> written_;  ///< written since the last barrier
  uint32_t query_capacity_ = 0;           ///< 0: dispatches are not timed
  std::vector<const char*> timed_;
  std::vector<Buffer> retired_;  ///< replaced, perhaps in use by what has been recorded
};

}  // namespace surefield::gpu
