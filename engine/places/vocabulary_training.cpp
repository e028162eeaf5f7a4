#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <vector>

#include "engine/places/vocabulary.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

std::vector<NearestWord> assign(const LocalFeatures& features, const LocalFeatures& words) {
  std::vector<NearestWord> nearest;
  for (Eigen::Index i = 0; i < features.rows(); ++i) nearest.push_back(nearest_word(words, features.row(i)));
  return nearest;
}

/// k-means++: each word is a feature, drawn with a probability that goes with the squared distance to the
/// nearest word so far.
LocalFeatures first_words(const LocalFeatures& features, int count, std::mt19937& random) {
  LocalFeatures words(count, kFeatureSize);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(features.rows());
  for (int word = 0; word < count; ++word) {
    double rest = weights.sum() * (static_cast<double>(random()) * 0x1p-32);
    Eigen::Index drawn = 0;
    while (drawn + 1 < features.rows() && (rest -= weights[drawn]) >= 0) ++drawn;
    words.row(word) = features.row(drawn);
    const Eigen::VectorXd apart =
        (features.rowwise() - words.row(word)).rowwise().squaredNorm().cast<double>();
    weights = word == 0 ? apart : weights.cwiseMin(apart).eval();
  }
  return words;
}

/// Each word becomes the mean of its features; one without any becomes the feature that is worst off.
LocalFeatures mean_features(const LocalFeatures& features, std::vector<NearestWord> nearest,
                            Eigen::Index count) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(count, kFeatureSize);
  Eigen::VectorXd members = Eigen::VectorXd::Zero(count);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    sums.row(nearest[i].word) += features.row(static_cast<Eigen::Index>(i)).cast<double>();
    ++members[nearest[i].word];
  }
  for (Eigen::Index word = 0; word < count; ++word) {
    if (members[word] > 0) {
      sums.row(word) /= members[word];
      continue;
    }
    const auto farthest = std::max_element(nearest.begin(), nearest.end(),
                                           [](auto& a, auto& b) { return a.distance < b.distance; });
    farthest->distance = 0;
    sums.row(word) = features.row(farthest - nearest.begin()).cast<double>();
  }
  return sums.cast<float>();
}

bool same_words(const std::vector<NearestWord>& a, const std::vector<NearestWord>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](auto& one, auto& other) { return one.word == other.word; });
}

}  // namespace

Vocabulary train_vocabulary(const LocalFeatures& features, const VocabularySettings& settings,
                            const std::function<bool(int)>& round) {
  if (features.rows() < settings.words) {
    throw InputError(
        fmt::format("{} features are too few for {} words; give more frames or a smaller --words",
                    features.rows(), settings.words));
  }
  std::mt19937 random(static_cast<uint32_t>(settings.seed));
  Vocabulary vocabulary{first_words(features, settings.words, random)};
  std::vector<NearestWord> before;
  for (int i = 1; i <= settings.rounds; ++i) {
    std::vector<NearestWord> nearest = assign(features, vocabulary.words);
    if (same_words(nearest, before)) break;
    vocabulary.words = mean_features(features, nearest, settings.words);
    before = std::move(nearest);
    if (!round(i)) break;
  }
  return vocabulary;
}

}  // namespace surefield
