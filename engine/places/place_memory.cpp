#include "engine/places/place_memory.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "engine/places/vlad.h"

namespace surefield {

void PlaceMemory::add(const LocalFeatures& features) {
  descriptors_.push_back(vlad_of(features, vocabulary_));
}

void PlaceMemory::replace_last(const LocalFeatures& features) {
  descriptors_.back() = vlad_of(features, vocabulary_);
}

std::vector<double> PlaceMemory::similarities(const LocalFeatures& features) const {
  const Eigen::VectorXf own = vlad_of(features, vocabulary_);
  std::vector<double> similarities;
  for (const Eigen::VectorXf& descriptor : descriptors_) similarities.push_back(descriptor.dot(own));
  return similarities;
}

std::vector<double> PlaceMemory::similarities(int keyframe) const {
  std::vector<double> similarities;
  for (int k = 0; k < keyframe; ++k) similarities.push_back(descriptors_[k].dot(descriptors_[keyframe]));
  return similarities;
}

std::vector<int> best_apart(const std::vector<double>& scores, int count, int apart, double least) {
  std::vector<std::pair<double, int>> order;
  for (int k = 0; k < static_cast<int>(scores.size()); ++k)
    if (scores[k] > least) order.emplace_back(scores[k], k);
  std::sort(order.rbegin(), order.rend());
  std::vector<int> best;
  for (const auto& [score, k] : order) {
    if (static_cast<int>(best.size()) >= count) break;
    const bool beside = std::any_of(best.begin(), best.end(), [&, k = k](int other) {
      return std::abs(other - k) <= apart;
    });
    if (!beside) best.push_back(k);
  }
  return best;
}

}  // namespace surefield
