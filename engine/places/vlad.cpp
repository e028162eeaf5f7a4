#include "engine/places/vlad.h"

namespace surefield {

Eigen::VectorXf VladDescriptor::describe(const cv::Mat& rgb) {
  const LocalFeatures& words = vocabulary_.words;
  LocalFeatures sums = LocalFeatures::Zero(words.rows(), kFeatureSize);
  const LocalFeatures features = root_sift(rgb);
  for (Eigen::Index i = 0; i < features.rows(); ++i) {
    const Eigen::Index word = nearest_word(words, features.row(i)).word;
    sums.row(word) += features.row(i) - words.row(word);
  }
  // Eigen's normalize() leaves zeros as they are.
  for (Eigen::Index word = 0; word < sums.rows(); ++word) sums.row(word).normalize();
  Eigen::VectorXf descriptor = Eigen::Map<const Eigen::VectorXf>(sums.data(), sums.size());
  descriptor.normalize();
  return descriptor;
}

}  // namespace surefield
