#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "engine/places/local_features.h"

namespace surefield {

/// Visual words: local features that stand for all like them. A row each.
struct Vocabulary {
  LocalFeatures words;
};

/// The word nearest to a feature.
struct NearestWord {
  Eigen::Index word = 0;
  float distance = 0;  ///< squared
};

NearestWord nearest_word(const LocalFeatures& words, const Eigen::Matrix<float, 1, kFeatureSize>& feature);

/// The words in a text file: a row a line, 128 whole numbers, thousandths; lines that start with '#' are
/// comments. Throws InputError with the line where the file is something else.
Vocabulary read_vocabulary(const std::filesystem::path& file);

/// The vocabulary that the program carries inside it, configs/vocabulary.txt.
Vocabulary built_in_vocabulary();

/// The text of such a file; `heading` stands before it as a comment of one line.
std::string vocabulary_text(const Vocabulary& vocabulary, const std::string& heading);

/// How to find words.
struct VocabularySettings {
  int words = 64;
  int seed = 1;
  int rounds = 50;  ///< of k-means, at most
};

/// Clusters features into words by k-means, from starts that k-means++ draws: the same features give the same
/// words. `round` is told the number of each round that is done, and ends it all, with the words so far, by
/// returning false. Throws InputError where there are fewer features than words.
Vocabulary train_vocabulary(const LocalFeatures& features, const VocabularySettings& settings,
                            const std::function<bool(int)>& round);

}  // namespace surefield
