#include "engine/gpu/recorder.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/gpu/barrier.h"
#include "engine/gpu/error.h"

namespace surefield::gpu {

namespace {

/// Refuses what a driver would answer with undefined behaviour.
void check_slice(const Device& device, const Pipeline& pass, const BindingInfo& binding, const Slice& slice) {
  if (slice.bytes == 0 || slice.offset + slice.bytes > slice.buffer->bytes())
    throw Error(Error::Kind::Limit,
                fmt::format("pass {}: {} is bound beyond its buffer", pass.name(), binding.name));
  if (slice.bytes > device.limits().storage_range_bytes)
    throw Error(
        Error::Kind::Limit,
        fmt::format("pass {}: {} needs {:.0f} MB in one binding, the device allows {:.0f}: use a smaller "
                    "map or image, or another --device",
                    pass.name(), binding.name, static_cast<double>(slice.bytes) / 1e6,
                    static_cast<double>(device.limits().storage_range_bytes) / 1e6));
}

}  // namespace

Recorder::Recorder(Device& device)
    : device_(device), objects_(device.recordings().take()), commands_(objects_.commands) {
  begin();
}

Recorder::~Recorder() {
  device_.recordings().give_back(objects_);
}

void Recorder::begin() {
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands_, &info), "beginning a command buffer");
  if (query_capacity_) vkCmdResetQueryPool(commands_, objects_.queries, 0, query_capacity_);
}

void Recorder::enable_timestamps(uint32_t capacity) {
  if (query_capacity_ || device_.limits().timestamp_ns == 0) return;
  device_.recordings().reserve_queries(objects_, capacity * 2);
  query_capacity_ = capacity * 2;
  vkCmdResetQueryPool(commands_, objects_.queries, 0, query_capacity_);
}

void Recorder::touch(std::span<const VkBuffer> reads, std::span<const VkBuffer> writes) {
  const auto hazard = [&] {
    for (VkBuffer b : reads)
      if (written_.contains(b)) return true;
    for (VkBuffer b : writes)
      if (written_.contains(b) || read_.contains(b)) return true;
    return false;
  };
  if (hazard()) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT |
                           VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = barrier.srcStageMask;
    barrier.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                            VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                            VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands_, &dependency);
    read_.clear();
    written_.clear();
  }
  read_.insert(reads.begin(), reads.end());
  written_.insert(writes.begin(), writes.end());
}

void Recorder::prepare(const Pipeline& pass, std::span<const Slice> slices, const void* params,
                       const Buffer* indirect) {
  std::vector<VkBuffer> reads, writes;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const BindingInfo& binding = pass.bindings()[i];
    check_slice(device_, pass, binding, slices[i]);
    if (binding.access != Access::Write) reads.push_back(slices[i].buffer->handle());
    if (binding.access != Access::Read) writes.push_back(slices[i].buffer->handle());
  }
  if (indirect) reads.push_back(indirect->handle());
  touch(reads, writes);
  vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pass.handle());
  bind(pass, slices);
  if (pass.params_bytes())
    vkCmdPushConstants(commands_, pass.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, pass.params_bytes(), params);
}

void Recorder::bind(const Pipeline& pass, std::span<const Slice> slices) {
  std::vector<VkDescriptorBufferInfo> infos;
  for (const Slice& slice : slices) infos.push_back({slice.buffer->handle(), slice.offset, slice.bytes});
  const VkDescriptorSet set =
      device_.limits().push_descriptors ? VK_NULL_HANDLE : allocate_set(pass.set_layout());
  std::vector<VkWriteDescriptorSet> writes;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.dstBinding = pass.bindings()[i].slot;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &infos[i];
    writes.push_back(write);
  }
  if (device_.limits().push_descriptors) {
    device_.push_descriptor_set()(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pass.layout(), 0,
                                  static_cast<uint32_t>(writes.size()), writes.data());
  } else {
    vkUpdateDescriptorSets(device_.handle(), static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pass.layout(), 0, 1, &set, 0, nullptr);
  }
}

VkDescriptorSet Recorder::allocate_set(VkDescriptorSetLayout layout) {
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  for (; pools_full_ < objects_.descriptor_pools.size(); ++pools_full_) {
    info.descriptorPool = objects_.descriptor_pools[pools_full_];
    if (vkAllocateDescriptorSets(device_.handle(), &info, &set) == VK_SUCCESS) return set;
  }
  info.descriptorPool = device_.recordings().add_descriptor_pool(objects_);
  check(vkAllocateDescriptorSets(device_.handle(), &info, &set), "allocating a descriptor set");
  return set;
}

void Recorder::timestamp(const char* pass) {
  if (device_.times_passes()) enable_timestamps();
  if (!query_capacity_ || timed_.size() >= query_capacity_) return;
  vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, objects_.queries,
                       static_cast<uint32_t>(timed_.size()));
  timed_.push_back(pass);
}

void Recorder::run(const Pipeline& pass, uint32_t groups_x, uint32_t groups_y) {
  if (groups_x > device_.limits().workgroups_x || groups_y > device_.limits().workgroups_y)
    throw Error(Error::Kind::Limit, fmt::format("pass {}: {} x {} workgroups are more than the device allows",
                                                pass.name(), groups_x, groups_y));
  timestamp(pass.name());
  vkCmdDispatch(commands_, groups_x, groups_y, 1);
  timestamp(pass.name());
}

void Recorder::run_indirect(const Pipeline& pass, const Slice& group_counts) {
  timestamp(pass.name());
  vkCmdDispatchIndirect(commands_, group_counts.buffer->handle(), group_counts.offset);
  timestamp(pass.name());
}

void Recorder::check_range(const Slice& range, const char* doing) {
  if (range.offset + range.bytes > range.buffer->bytes())
    throw Error(Error::Kind::Limit, fmt::format("{} beyond the end of {}", doing, range.buffer->name()));
}

void Recorder::fill(const Slice& range, uint32_t value) {
  check_range(range, "filling");
  const VkBuffer handle = range.buffer->handle();
  touch({}, {&handle, 1});
  vkCmdFillBuffer(commands_, handle, range.offset, range.bytes, value);
}

void Recorder::copy(const Slice& source, const Slice& target) {
  check_range(source, "copying from");
  check_range({target.buffer, target.offset, source.bytes}, "copying to");
  const VkBuffer from = source.buffer->handle(), to = target.buffer->handle();
  touch({&from, 1}, {&to, 1});
  copy_raw(from, source.offset, to, target.offset, source.bytes);
}

void Recorder::copy_raw(VkBuffer source, uint64_t source_offset, VkBuffer target, uint64_t target_offset,
                        uint64_t bytes) {
  const VkBufferCopy region{source_offset, target_offset, bytes};
  vkCmdCopyBuffer(commands_, source, target, 1, &region);
}

std::vector<PassTime> Recorder::read_times() {
  std::vector<uint64_t> ticks(timed_.size());
  if (timed_.empty()) return {};
  check(vkGetQueryPoolResults(device_.handle(), objects_.queries, 0, static_cast<uint32_t>(ticks.size()),
                              ticks.size() * 8, ticks.data(), 8,
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "reading timestamps");
  std::vector<PassTime> times;
  for (std::size_t i = 0; i + 1 < ticks.size(); i += 2)
    times.push_back(
        {timed_[i], static_cast<double>(ticks[i + 1] - ticks[i]) * device_.limits().timestamp_ns * 1e-6});
  timed_.clear();
  return times;
}

std::vector<PassTime> Recorder::submit() {
  // What the device wrote must be visible to the host and to the next submission.
  record_full_barrier(commands_);
  check(vkEndCommandBuffer(commands_), "ending a command buffer");
  device_.submit_and_wait(commands_);
  auto times = read_times();
  if (device_.times_passes()) device_.add_pass_times(times);

  retired_.clear();
  read_.clear();
  written_.clear();
  pools_full_ = 0;
  device_.recordings().reset(objects_);
  begin();
  return times;
}

}  // namespace surefield::gpu
