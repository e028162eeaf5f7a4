#include "engine/places/vlad.h"

namespace surefield {

Eigen::VectorXf vlad_of(const LocalFeatures& features, const Vocabulary& vocabulary) {
  const LocalFeatures& words = vocabulary.words;
  LocalFeatures sums = LocalFeatures::Zero(words.rows(), kFeatureSize);
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

Eigen::VectorXf VladDescriptor::describe(const cv::Mat& rgb) {
  return vlad_of(root_sift(rgb), vocabulary_);
}

}  // namespace surefield
