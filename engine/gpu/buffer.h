#pragma once

#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/gpu/device.h"
#include "engine/gpu/glsl_types.h"

namespace surefield::gpu {

/// A storage buffer in device memory, at least `bytes` large. Contents are undefined until written.
class Buffer {
 public:
  Buffer(Device& device, std::string name, uint64_t bytes);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  VkBuffer handle() const { return buffer_; }
  uint64_t bytes() const { return bytes_; }
  const std::string& name() const { return name_; }

  /// The size to replace the buffer by when it must hold `bytes`: half as large again, so that repeated
  /// growth is cheap, but not beyond what one binding may span unless `bytes` are.
  uint64_t grown_bytes(uint64_t bytes) const;

  /// Replaces the buffer by one of at least `bytes` (see grown_bytes) if it is smaller. With `keep`, the
  /// contents move along. Handles taken before are void when it returns true.
  bool reserve(uint64_t bytes, bool keep);

  /// Changes places with another buffer of the same device; each keeps its name.
  void exchange_memory(Buffer& other) noexcept;

  /// Copies host memory into the buffer at byte `offset`: `data` may change at once, and the bytes are there
  /// for all that is submitted or read back from here on (see StagingRing).
  void upload(const void* data, uint64_t offset, uint64_t bytes);
  /// Copies from the buffer into host memory; waits for the device.
  void download(void* data, uint64_t offset, uint64_t bytes) const;

 private:
  Device* device_;
  std::string name_;
  uint64_t bytes_ = 0;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  void release();
};

/// A device buffer of `T` (a type of glsl_types.h or shaders/shared/, in scalar layout).
template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Array(Device& device, std::string name, uint64_t count = 1)
      : buffer_(device, std::move(name), count * sizeof(T)) {}

  uint64_t capacity() const { return buffer_.bytes() / sizeof(T); }
  const Buffer& buffer() const { return buffer_; }
  Buffer& buffer() { return buffer_; }

  /// Grows to at least `count` entries; see Buffer::reserve.
  bool reserve(uint64_t count, bool keep = false) { return buffer_.reserve(count * sizeof(T), keep); }

  /// See Buffer::exchange_memory.
  void exchange_memory(Array& other) noexcept { buffer_.exchange_memory(other.buffer_); }

  /// Writes `data` from entry `first` on, growing if needed.
  void upload(std::span<const T> data, uint64_t first = 0) {
    reserve(first + data.size(), first > 0);
    buffer_.upload(data.data(), first * sizeof(T), data.size_bytes());
  }

  /// Reads `count` entries from `first` on.
  std::vector<T> download(uint64_t count, uint64_t first = 0) const {
    std::vector<T> data(count);
    buffer_.download(data.data(), first * sizeof(T), count * sizeof(T));
    return data;
  }

 private:
  Buffer buffer_;
};

/// A range of a buffer, as a pass binds it.
struct Slice {
  const Buffer* buffer;
  uint64_t offset;  ///< bytes
  uint64_t bytes;
};

template <class T>
class Ref;

/// The handle of any array seen as 32-bit words, for passes that copy whatever they are given.
template <class T>
Ref<glsl::uint> as_words(const Array<T>& array);

/// A typed, whole-array handle: what a pass's Bindings consist of. It has no default, so that a forgotten
/// buffer does not compile, and takes only an Array of the declared type.
template <class T>
class Ref {
 public:
  Ref(const Array<T>& array)
      : slice_{&array.buffer(), 0, array.buffer().bytes()} {}  // NOLINT: implicit by design
  const Slice& slice() const { return slice_; }

 private:
  explicit Ref(const Slice& slice) : slice_(slice) {}
  template <class U>
  friend Ref<glsl::uint> as_words(const Array<U>& array);

  Slice slice_;
};

template <class T>
Ref<glsl::uint> as_words(const Array<T>& array) {
  static_assert(sizeof(T) % sizeof(glsl::uint) == 0);
  return Ref<glsl::uint>(Slice{&array.buffer(), 0, array.buffer().bytes()});
}

}  // namespace surefield::gpu
