#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/places/local_features.h"
#include "engine/places/vocabulary.h"

namespace surefield {

/// Remembers what the keyframes of a run look like, and tells which of them a view resembles: by VLAD over
/// RootSIFT (vlad.h), which does not depend on poses. A keyframe is named by its position in the order of
/// adding.
class PlaceMemory {
 public:
  explicit PlaceMemory(Vocabulary vocabulary) : vocabulary_(std::move(vocabulary)) {}

  /// Adds the newest keyframe, or puts another in the place of the last one added.
  void add(const LocalFeatures& features);
  void replace_last(const LocalFeatures& features);

  /// The similarity of each keyframe to a view, a cosine in [-1, 1]; 0 where one of the two shows no features.
  std::vector<double> similarities(const LocalFeatures& features) const;
  /// The same, of a keyframe to those before it.
  std::vector<double> similarities(int keyframe) const;

 private:
  Vocabulary vocabulary_;
  std::vector<Eigen::VectorXf> descriptors_;
};

/// The `count` positions of the highest scores, the best first, none within `apart` of a better one and none
/// of a score that is not above `least`; of equals the later first.
std::vector<int> best_apart(const std::vector<double>& scores, int count, int apart, double least);

}  // namespace surefield
