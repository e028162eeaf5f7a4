#include "engine/slam/covisibility.h"

#include "engine/places/netvlad.h"
#include "engine/places/vlad.h"
#include "engine/types/error.h"

namespace surefield {

std::unique_ptr<ImageDescriptor> make_descriptor(const KeyframeSettings& settings) {
  if (settings.covisibility == CovisibilityKind::Vlad) {
    return std::make_unique<VladDescriptor>(
        settings.vocabulary.empty() ? built_in_vocabulary() : read_vocabulary(settings.vocabulary));
  }
  if (settings.covisibility == CovisibilityKind::NetVlad) {
    if (settings.netvlad.empty()) {
      throw InputError(
          "keyframes.covisibility netvlad needs a network: name its ONNX file with keyframes.netvlad, or "
          "choose vlad, which needs none");
    }
    return std::make_unique<NetVladDescriptor>(settings.netvlad);
  }
  return nullptr;
}

Covisibility::Covisibility(const KeyframeSettings& settings)
    : size_(settings.window), descriptor_(make_descriptor(settings)) {}

void Covisibility::add(const Frame& frame) {
  if (descriptor_) pool_.add(descriptor_->describe(frame.colour));
}

std::vector<int> Covisibility::similar() const {
  return pool_.most_similar(size_ - 2);
}

KeyframeWindow Covisibility::window(const std::vector<Keyframe>& keyframes,
                                    const std::vector<int>& near) const {
  const int current = static_cast<int>(keyframes.size()) - 1;
  if (!descriptor_) {
    return select_window(current, near, size_,
                         [&](int k) { return overlap(keyframes[current], keyframes[k]); });
  }
  const std::vector<double> similarities = pool_.similarities();
  return select_window(current, near, size_, [&](int k) { return similarities[k]; });
}

}  // namespace surefield
