#include "engine/gpu/buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "engine/gpu/error.h"
#include "engine/gpu/recorder.h"

namespace surefield::gpu {

namespace {

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

struct Allocation {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
};

void free_allocation(Device& device, Allocation& allocation) {
  if (allocation.buffer) vkDestroyBuffer(device.handle(), allocation.buffer, nullptr);
  if (allocation.memory) vkFreeMemory(device.handle(), allocation.memory, nullptr);
  allocation = {};
}

Allocation allocate(Device& device, uint64_t bytes, VkMemoryPropertyFlags flags, const std::string& name) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = kUsage;
  Allocation allocation;
  const std::string doing = fmt::format("allocating {} ({:.1f} MB)", name, static_cast<double>(bytes) / 1e6);
  check(vkCreateBuffer(device.handle(), &info, nullptr, &allocation.buffer), doing.c_str());
  try {
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), allocation.buffer, &needs);
    VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    memory.allocationSize = needs.size;
    memory.memoryTypeIndex = device.memory_type(needs.memoryTypeBits, flags);
    check(vkAllocateMemory(device.handle(), &memory, nullptr, &allocation.memory), doing.c_str());
    check(vkBindBufferMemory(device.handle(), allocation.buffer, allocation.memory, 0), doing.c_str());
  } catch (...) {
    free_allocation(device, allocation);
    throw;
  }
  return allocation;
}

/// A host-visible buffer that lives for one transfer.
class Staging {
 public:
  Staging(Device& device, uint64_t bytes)
      : device_(device),
        allocation_(allocate(device, bytes,
                             VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                             "a staging buffer")) {
    const VkResult result = vkMapMemory(device.handle(), allocation_.memory, 0, VK_WHOLE_SIZE, 0, &data_);
    if (result != VK_SUCCESS) free_allocation(device, allocation_);
    check(result, "mapping a staging buffer");
  }
  ~Staging() { free_allocation(device_, allocation_); }
  Staging(const Staging&) = delete;

  void* data() const { return data_; }
  VkBuffer handle() const { return allocation_.buffer; }

 private:
  Device& device_;
  Allocation allocation_;
  void* data_ = nullptr;
};

}  // namespace

Buffer::Buffer(Device& device, std::string name, uint64_t bytes)
    : device_(&device), name_(std::move(name)), bytes_(std::max<uint64_t>(bytes, 16)) {
  bytes_ = (bytes_ + 15) / 16 * 16;
  const Allocation allocation = allocate(device, bytes_, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, name_);
  buffer_ = allocation.buffer;
  memory_ = allocation.memory;
  device.count_memory(static_cast<int64_t>(bytes_));
}

Buffer::~Buffer() {
  release();
}

Buffer::Buffer(Buffer&& other) noexcept
    : device_(other.device_),
      name_(std::move(other.name_)),
      bytes_(std::exchange(other.bytes_, 0)),
      buffer_(std::exchange(other.buffer_, VK_NULL_HANDLE)),
      memory_(std::exchange(other.memory_, VK_NULL_HANDLE)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  release();
  device_ = other.device_;
  name_ = std::move(other.name_);
  bytes_ = std::exchange(other.bytes_, 0);
  buffer_ = std::exchange(other.buffer_, VK_NULL_HANDLE);
  memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
  return *this;
}

void Buffer::exchange_memory(Buffer& other) noexcept {
  std::swap(bytes_, other.bytes_);
  std::swap(buffer_, other.buffer_);
  std::swap(memory_, other.memory_);
}

void Buffer::release() {
  if (!buffer_) return;
  Allocation allocation{buffer_, memory_};
  free_allocation(*device_, allocation);
  device_->count_memory(-static_cast<int64_t>(bytes_));
  buffer_ = VK_NULL_HANDLE;
}

uint64_t Buffer::grown_bytes(uint64_t bytes) const {
  return std::max(bytes, std::min(bytes_ + bytes_ / 2, device_->limits().storage_range_bytes / 16 * 16));
}

bool Buffer::reserve(uint64_t bytes, bool keep) {
  if (bytes <= bytes_) return false;
  Buffer larger(*device_, name_, grown_bytes(bytes));
  if (keep) {
    Recorder recorder(*device_);
    recorder.copy({this, 0, bytes_}, {&larger, 0, bytes_});
    recorder.submit();
  }
  *this = std::move(larger);
  return true;
}

void Buffer::upload(const void* data, uint64_t offset, uint64_t bytes) {
  if (bytes == 0) return;
  if (offset + bytes > bytes_) throw Error(Error::Kind::Limit, "upload beyond the end of " + name_);
  Staging staging(*device_, bytes);
  std::memcpy(staging.data(), data, bytes);
  Recorder recorder(*device_);
  recorder.copy_raw(staging.handle(), 0, buffer_, offset, bytes);
  recorder.submit();
}

void Buffer::download(void* data, uint64_t offset, uint64_t bytes) const {
  if (bytes == 0) return;
  if (offset + bytes > bytes_) throw Error(Error::Kind::Limit, "download beyond the end of " + name_);
  Staging staging(*device_, bytes);
  Recorder recorder(*device_);
  recorder.copy_raw(buffer_, offset, staging.handle(), 0, bytes);
  recorder.submit();
  std::memcpy(data, staging.data(), bytes);
}

}  // namespace surefield::gpu
