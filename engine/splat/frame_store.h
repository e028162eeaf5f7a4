#pragma once

#include <optional>
#include <span>
#include <unordered_map>

#include "engine/splat/packed_images.h"
#include "engine/splat/sensor_frame.h"

namespace surefield {

/// The frames that an engine holds: a few on the device, in memory that is used again and again, and the
/// others packed in host memory. Device memory is that of kPlaces frames, however many are held.
class FrameStore {
 public:
  /// Frames on the device. on_device() leaves the frames of the last kPlaces - 1 calls where they are.
  static constexpr std::size_t kPlaces = 8;

  explicit FrameStore(gpu::Device& device) : device_(device) {}

  FrameHandle load(const FrameView& view);
  void release(FrameHandle frame);
  /// Takes the flagged pixels out of a frame; see SplatEngine::hide().
  void hide(FrameHandle frame, std::span<const uint8_t> pixels);

  /// The frame on the device, brought there if need be; the reference is good for the next kPlaces - 1 calls.
  /// Throws UsageError for a frame that is not held.
  const SensorFrame& on_device(FrameHandle frame);

 private:
  struct Entry {
    std::optional<std::size_t> place;
    ImageSize size;
    uint32_t valid_pixels = 0;
    glsl::vec3 noise{};
    std::optional<PackedImages> packed;  ///< once it has left the device
  };
  struct Place {
    SensorFrame images;
    std::optional<FrameHandle> frame;
    uint64_t last_use = 0;
  };
  Place& place_of(FrameHandle frame);
  void make_places(const ImageSize& size);
  std::size_t free_place();
  void pack(Place& place);
  void unpack(const Entry& entry, SensorFrame& images) const;

  gpu::Device& device_;
  std::vector<Place> places_;
  std::unordered_map<FrameHandle, Entry> entries_;
  FrameHandle next_frame_ = 0;
  uint64_t uses_ = 0;
};

}  // namespace surefield
