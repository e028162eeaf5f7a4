#include "engine/places/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/places/built_in_vocabulary.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr float kUnit = 1000;  // of the numbers in the file

/// The numbers of a line, or an error that names it.
std::vector<double> parse_word(const std::string& line, const std::filesystem::path& file, int number) {
  const auto values = parse_numbers(line);
  const auto is_valid = [](double value) { return value >= 0 && value <= kUnit; };
  if (!values || values->size() != kFeatureSize || !std::all_of(values->begin(), values->end(), is_valid)) {
    throw InputError(file, number,
                     fmt::format("a word is a line of {} numbers from 0 to {:.0f}; make such a file with "
                                 "surefield vocabulary",
                                 kFeatureSize, kUnit));
  }
  return *values;
}

Vocabulary parse_vocabulary(const std::string& text, const std::filesystem::path& file) {
  std::vector<std::vector<double>> words;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (!line.empty() && line[0] != '#') words.push_back(parse_word(line, file, number));
  if (words.empty()) throw InputError(file, "holds no words; make such a file with surefield vocabulary");
  Vocabulary vocabulary{LocalFeatures(words.size(), kFeatureSize)};
  for (std::size_t i = 0; i < words.size(); ++i)
    for (int j = 0; j < kFeatureSize; ++j)
      vocabulary.words(static_cast<Eigen::Index>(i), j) =
          static_cast<float>(words[i][static_cast<std::size_t>(j)]) / kUnit;
  return vocabulary;
}

}  // namespace

NearestWord nearest_word(const LocalFeatures& words, const Eigen::Matrix<float, 1, kFeatureSize>& feature) {
  NearestWord nearest{0, std::numeric_limits<float>::infinity()};
  for (Eigen::Index word = 0; word < words.rows(); ++word) {
    const float distance = (words.row(word) - feature).squaredNorm();
    if (distance < nearest.distance) nearest = {word, distance};
  }
  return nearest;
}

Vocabulary read_vocabulary(const std::filesystem::path& file) {
  return parse_vocabulary(read_file(file), file);
}

Vocabulary built_in_vocabulary() {
  return parse_vocabulary(built_in_vocabulary_text(), "configs/vocabulary.txt");
}

std::string vocabulary_text(const Vocabulary& vocabulary, const std::string& heading) {
  std::string text = "# " + heading + "\n";
  for (Eigen::Index i = 0; i < vocabulary.words.rows(); ++i)
    for (int j = 0; j < kFeatureSize; ++j)
      text +=
          fmt::format("{}{}", std::lround(vocabulary.words(i, j) * kUnit), j + 1 < kFeatureSize ? ' ' : '\n');
  return text;
}

}  // namespace surefield
