#pragma once

#include <memory>
#include <vector>

#include "engine/places/descriptor_pool.h"
#include "engine/places/image_descriptor.h"
#include "engine/slam/keyframes.h"
#include "engine/slam/settings.h"

namespace surefield {

/// Finds the keyframes that see what the newest one sees: by the overlap of what they are thought to see, or
/// by the similarity of their images, which does not depend on poses that may have drifted.
class Covisibility {
 public:
  /// Images are described by `descriptor`, by the one that the settings name where it is null. Throws
  /// InputError where a file that the settings name cannot be used.
  explicit Covisibility(const KeyframeSettings& settings,
                        std::unique_ptr<ImageDescriptor> descriptor = nullptr);

  /// The descriptor of a frame; empty where images are not described. Throws what the descriptor throws, and
  /// UsageError where its vectors differ in length.
  Eigen::VectorXf describe(const Frame& frame);
  /// There is a new keyframe, whose descriptor is this.
  void add(Eigen::VectorXf descriptor);

  /// The k - 2 keyframes that look most like the newest, the best first, wherever they are thought to be;
  /// none where images are not described.
  std::vector<int> similar() const;

  /// The window of the newest keyframe, out of those `near` it; see select_window().
  KeyframeWindow window(const std::vector<Keyframe>& keyframes, const std::vector<int>& near) const;

 private:
  int size_;                                     ///< k, of the window
  std::unique_ptr<ImageDescriptor> descriptor_;  ///< null: by overlap
  Eigen::Index length_ = 0;                      ///< of the descriptors; 0: there is none yet
  DescriptorPool pool_;
};

/// What describes images as the settings ask; null for CovisibilityKind::Overlap. Throws InputError.
std::unique_ptr<ImageDescriptor> make_descriptor(const KeyframeSettings& settings);

}  // namespace surefield
