#include "engine/splat/frame_store.h"

#include <algorithm>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr float kHidden = -1;  // in the place of a depth: see SensorFrame

}  // namespace

/// Makes all places at once, so that a later frame allocates nothing.
void FrameStore::make_places(const ImageSize& size) {
  places_.reserve(kPlaces);
  while (places_.size() < kPlaces) {
    places_.push_back({SensorFrame(device_), std::nullopt});
    places_.back().images.reserve(size);
  }
}

FrameHandle FrameStore::load(const FrameView& view) {
  make_places({static_cast<uint32_t>(view.width), static_cast<uint32_t>(view.height)});
  const std::size_t at = free_place();
  Place& place = places_[at];
  place.images.assign(view);
  place.last_use = ++uses_;
  place.frame = next_frame_;
  entries_[next_frame_] = {at, place.images.size, place.images.valid_pixels, place.images.noise,
                           std::nullopt};
  return next_frame_++;
}

void FrameStore::release(FrameHandle frame) {
  const auto entry = entries_.find(frame);
  if (entry == entries_.end()) return;
  if (entry->second.place) places_[*entry->second.place].frame.reset();
  entries_.erase(entry);
}

const SensorFrame& FrameStore::on_device(FrameHandle frame) {
  return place_of(frame).images;
}

void FrameStore::hide(FrameHandle frame, std::span<const uint8_t> pixels) {
  SensorFrame& images = place_of(frame).images;
  if (pixels.size() != images.size.pixels()) throw UsageError("the flags are not of the frame's size");
  std::vector<float> depth = images.depth.download(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels[i]) continue;
    images.valid_pixels -= depth[i] > 0;
    depth[i] = kHidden;
  }
  images.depth.upload(depth);
  Entry& entry = entries_.at(frame);
  entry.valid_pixels = images.valid_pixels;
  entry.packed.reset();
}

FrameStore::Place& FrameStore::place_of(FrameHandle frame) {
  const auto held = entries_.find(frame);
  if (held == entries_.end()) throw UsageError("the engine does not hold this frame");
  Entry& entry = held->second;
  if (!entry.place) {
    const std::size_t at = free_place();
    unpack(entry, places_[at].images);
    places_[at].frame = frame;
    entry.place = at;
  }
  Place& place = places_[*entry.place];
  place.last_use = ++uses_;
  return place;
}

/// A place for another frame: a free one, else that of the frame that was not asked for the longest.
std::size_t FrameStore::free_place() {
  const auto is_free = [](const Place& place) { return !place.frame; };
  auto found = std::find_if(places_.begin(), places_.end(), is_free);
  if (found == places_.end()) {
    found = std::min_element(places_.begin(), places_.end(),
                             [](const Place& a, const Place& b) { return a.last_use < b.last_use; });
    pack(*found);
  }
  return static_cast<std::size_t>(found - places_.begin());
}

/// Frees a place; the frame's images are read back the first time that it leaves the device.
void FrameStore::pack(Place& place) {
  Entry& entry = entries_.at(*place.frame);
  const uint64_t pixels = entry.size.pixels();
  if (!entry.packed)
    entry.packed.emplace(place.images.colour.download(pixels), place.images.depth.download(pixels));
  entry.place.reset();
  place.frame.reset();
}

void FrameStore::unpack(const Entry& entry, SensorFrame& images) const {
  images.size = entry.size;
  images.valid_pixels = entry.valid_pixels;
  images.noise = entry.noise;
  images.colour.upload(entry.packed->colour());
  images.depth.upload(entry.packed->depth());
}

}  // namespace surefield
