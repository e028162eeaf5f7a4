#pragma once

#include <Eigen/Core>
#include <vector>

namespace surefield {

/// The descriptors of all keyframes so far (paper section 3.4).
class DescriptorPool {
 public:
  /// Adds the descriptor of the newest keyframe; of unit length or zero, and as long as the others.
  void add(Eigen::VectorXf descriptor) { descriptors_.push_back(std::move(descriptor)); }

  /// The cosine similarity of each keyframe to the newest, in [-1, 1] and in the order of adding; the last is
  /// the newest's own. Empty where nothing was added.
  std::vector<double> similarities() const;

  /// The `count` earlier keyframes that are most similar to the newest, the best first, the one just before
  /// it left out; of equals the more recent first. None that has no similarity.
  std::vector<int> most_similar(int count) const;

 private:
  std::vector<Eigen::VectorXf> descriptors_;
};

}  // namespace surefield
