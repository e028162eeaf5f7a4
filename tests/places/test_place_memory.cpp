#include "engine/places/place_memory.h"

#include <doctest/doctest.h>

#include "engine/synth/random.h"

using namespace surefield;

namespace {

/// `count` features of unit length near words of the vocabulary, drawn by `seed`.
LocalFeatures features_of(const Vocabulary& vocabulary, uint32_t seed, int count) {
  RandomStream random(seed);
  LocalFeatures features(count, kFeatureSize);
  for (int i = 0; i < count; ++i) {
    const auto word =
        static_cast<Eigen::Index>(random.uniform(0, static_cast<double>(vocabulary.words.rows()) - 0.01));
    features.row(i) = vocabulary.words.row(word);
    for (int n = 0; n < kFeatureSize; ++n) features(i, n) += static_cast<float>(random.uniform(0, 0.05));
    features.row(i).normalize();
  }
  return features;
}

}  // namespace

TEST_CASE("a view resembles the keyframe with its features most, and one without features nothing") {
  const Vocabulary vocabulary = built_in_vocabulary();
  PlaceMemory memory(vocabulary);
  CHECK(memory.similarities(features_of(vocabulary, 1, 50)).empty());
  for (uint32_t seed = 1; seed <= 5; ++seed) memory.add(features_of(vocabulary, seed, 60));
  memory.add(LocalFeatures(0, kFeatureSize));
  const std::vector<double> found = memory.similarities(features_of(vocabulary, 3, 60));
  REQUIRE(found.size() == 6);
  CHECK(found[2] == doctest::Approx(1).epsilon(1e-4));
  CHECK(best_apart(found, 1, 0, 0) == std::vector<int>{2});
  CHECK(found[5] == 0);
  for (double similarity : memory.similarities(5)) CHECK(similarity == 0);
  CHECK(memory.similarities(0).empty());
  CHECK(memory.similarities(4)[1] == doctest::Approx(memory.similarities(features_of(vocabulary, 5, 60))[1]));
  memory.replace_last(features_of(vocabulary, 3, 60));
  CHECK(memory.similarities(5)[2] == doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("the best are apart from each other, of equals the later comes first") {
  const std::vector<double> scores = {0.1, 0.9, 0.95, 0.2, 0.8, 0.8, 0};
  CHECK(best_apart(scores, 3, 0, 0) == std::vector<int>{2, 1, 5});
  CHECK(best_apart(scores, 3, 1, 0) == std::vector<int>{2, 5, 0});
  CHECK(best_apart(scores, 9, 0, 0.5) == std::vector<int>{2, 1, 5, 4});
  CHECK(best_apart(scores, 9, 10, 0) == std::vector<int>{2});
  CHECK(best_apart(scores, 0, 0, 0).empty());
  CHECK(best_apart({}, 3, 0, 0).empty());
}
