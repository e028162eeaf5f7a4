#include "engine/places/descriptor_pool.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace surefield {

std::vector<double> DescriptorPool::similarities() const {
  std::vector<double> similarities;
  for (const Eigen::VectorXf& descriptor : descriptors_)
    similarities.push_back(descriptor.dot(descriptors_.back()));
  return similarities;
}

std::vector<int> DescriptorPool::most_similar(int count) const {
  const std::vector<double> all = similarities();
  std::vector<std::pair<double, int>> others;
  for (int k = 0; k < static_cast<int>(all.size()) - 2; ++k)
    if (all[k] > 0) others.emplace_back(all[k], k);
  std::sort(others.rbegin(), others.rend());
  if (static_cast<int>(others.size()) > count) others.resize(std::max(count, 0));
  std::vector<int> best;
  for (const auto& [similarity, k] : others) best.push_back(k);
  return best;
}

}  // namespace surefield
