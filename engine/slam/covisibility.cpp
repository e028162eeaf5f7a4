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

Covisibility::Covisibility(const KeyframeSettings& settings, std::unique_ptr<ImageDescriptor> descriptor)
    : size_(settings.window), descriptor_(descriptor ? std::move(descriptor) : make_descriptor(settings)) {}

Eigen::VectorXf Covisibility::describe(const Frame& frame) {
  if (!descriptor_) return {};
  Eigen::VectorXf descriptor = descriptor_->describe(frame.colour);
  if (descriptor.size() == 0 || (length_ > 0 && descriptor.size() != length_))
    throw UsageError("the descriptors of images do not have one length");
  return descriptor;
}

void Covisibility::add(Eigen::VectorXf descriptor) {
  if (!descriptor_) return;
  length_ = descriptor.size();
  pool_.add(std::move(descriptor));
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
