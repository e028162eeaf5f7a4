#include "engine/gpu/buffer.h"

#include <algorithm>
#include <utility>

#include "engine/gpu/allocation.h"
#include "engine/gpu/error.h"
#include "engine/gpu/recorder.h"
#include "engine/gpu/staging_ring.h"

namespace surefield::gpu {

Buffer::Buffer(Device& device, std::string name, uint64_t bytes)
    : device_(&device), name_(std::move(name)), bytes_(std::max<uint64_t>(bytes, 16)) {
  bytes_ = (bytes_ + 15) / 16 * 16;
  const Allocation allocation =
      allocate(device, bytes_, {.required = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT}, name_);
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
  device_->staging().forget(buffer_);
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
  device_->staging().upload(data, buffer_, offset, bytes);
}

void Buffer::download(void* data, uint64_t offset, uint64_t bytes) const {
  if (bytes == 0) return;
  if (offset + bytes > bytes_) throw Error(Error::Kind::Limit, "download beyond the end of " + name_);
  device_->staging().download(data, buffer_, offset, bytes);
}

}  // namespace surefield::gpu
