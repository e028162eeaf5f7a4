// Finding keyframes by their images: features, words, descriptors, the pool.
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/io/files.h"
#include "engine/places/vlad.h"
#include "engine/slam/covisibility.h"
#include "engine/synth/random.h"
#include "tests/support/input_files.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// A wall of many rectangles and discs of random colours, 480 x 240; `seed` chooses them.
cv::Mat wall(uint32_t seed) {
  RandomStream random(seed);
  cv::Mat image(240, 480, CV_8UC3, cv::Scalar(120, 120, 120));
  for (int i = 0; i < 160; ++i) {
    const cv::Point at(random.index(480), random.index(240));
    const cv::Scalar colour(random.index(256), random.index(256), random.index(256));
    if (seed % 2)
      cv::circle(image, at, 3 + random.index(20), colour, cv::FILLED);
    else
      cv::rectangle(image, cv::Rect(at, cv::Size(4 + random.index(40), 4 + random.index(40))), colour,
                    cv::FILLED);
  }
  return image;
}

/// What a camera of 320 x 240 sees of a wall, so many pixels from its left end.
cv::Mat view(const cv::Mat& wall, int left) {
  return wall(cv::Rect(left, 0, 320, 240)).clone();
}

VladDescriptor built_in() {
  return VladDescriptor(built_in_vocabulary());
}

Frame frame_of(const cv::Mat& colour) {
  return {.colour = colour, .depth = cv::Mat(colour.size(), CV_32FC1, cv::Scalar(2))};
}

/// Features around three corners of the unit cube's first face.
LocalFeatures clustered_features() {
  RandomStream random(5);
  LocalFeatures features = LocalFeatures::Zero(60, kFeatureSize);
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < kFeatureSize; ++j)
      features(i, j) = (j == i % 3 ? 0.9f : 0.1f) + static_cast<float>(random.uniform(-0.02, 0.02));
  return features;
}

}  // namespace

TEST_CASE("descriptors in bytes are as similar to each other as they were") {
  const LocalFeatures features = root_sift(view(wall(1), 0));
  REQUIRE(features.rows() > 50);
  const FeatureBytes bytes = to_bytes(features);
  const LocalFeatures back = to_floats(bytes);
  CHECK((back.rowwise().norm().array() - 1).abs().maxCoeff() < 1e-5f);
  for (Eigen::Index i = 0; i < features.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      CHECK(std::abs(back.row(i).dot(back.row(j)) - features.row(i).dot(features.row(j))) < 0.01f);
  CHECK(to_floats(FeatureBytes::Zero(1, kFeatureSize)).isZero(0));
  CHECK(to_floats(FeatureBytes(0, kFeatureSize)).rows() == 0);
}

TEST_CASE("RootSIFT has rows of unit length, none where nothing stands out, the same for any threads") {
  const LocalFeatures features = root_sift(view(wall(1), 0));
  REQUIRE(features.rows() > 50);
  for (Eigen::Index i = 0; i < features.rows(); ++i)
    REQUIRE(features.row(i).norm() == doctest::Approx(1).epsilon(1e-4));
  CHECK(root_sift(cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 90, 90))).rows() == 0);
  CHECK(root_sift(cv::Mat(3, 4, CV_8UC3, cv::Scalar(90, 90, 90))).rows() == 0);
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const LocalFeatures alone = root_sift(view(wall(1), 0));
  cv::setNumThreads(threads);
  CHECK(alone == features);
}

TEST_CASE("VLAD of a moved view is more similar than that of another scene, and of the same view the same") {
  VladDescriptor vlad = built_in();
  const Eigen::VectorXf here = vlad.describe(view(wall(1), 0));
  CHECK(here.size() == built_in_vocabulary().words.size());
  CHECK(here.norm() == doctest::Approx(1));
  CHECK(here == vlad.describe(view(wall(1), 0)));
  const float moved = here.dot(vlad.describe(view(wall(1), 60)));
  const float farther = here.dot(vlad.describe(view(wall(1), 140)));
  const float elsewhere = here.dot(vlad.describe(view(wall(2), 0)));
  CHECK(moved < 0.999f);
  CHECK(moved > farther);
  CHECK(farther > elsewhere + 0.1f);
}

TEST_CASE("VLAD adds up what features differ from their nearest words by") {
  Vocabulary two{LocalFeatures::Zero(2, kFeatureSize)};
  two.words(0, 0) = 1;
  two.words(1, 1) = 1;
  CHECK(nearest_word(two.words, two.words.row(1)).word == 1);
  CHECK(nearest_word(two.words, two.words.row(1)).distance == 0);
  CHECK(nearest_word(two.words, two.words.row(0) * 0.5f).distance == doctest::Approx(0.25));
  const cv::Mat image = view(wall(1), 0);
  const LocalFeatures features = root_sift(image);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(2, kFeatureSize);
  for (Eigen::Index i = 0; i < features.rows(); ++i) {
    const Eigen::Index word = nearest_word(two.words, features.row(i)).word;
    sums.row(word) += (features.row(i) - two.words.row(word)).cast<double>();
  }
  sums.rowwise().normalize();
  const Eigen::VectorXf descriptor = VladDescriptor(two).describe(image);
  for (int word = 0; word < 2; ++word)
    for (int j = 0; j < kFeatureSize; ++j)
      REQUIRE(descriptor[word * kFeatureSize + j] ==
              doctest::Approx(sums(word, j) / std::sqrt(2)).epsilon(1e-3).scale(0.01));
}

TEST_CASE("an image without features is similar to nothing") {
  VladDescriptor vlad = built_in();
  const Eigen::VectorXf blank = vlad.describe(cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 90, 90)));
  CHECK(blank.size() == built_in_vocabulary().words.size());
  CHECK(blank.isZero(0));
}

TEST_CASE("the pool compares the newest keyframe with all, and finds the most similar but the one before") {
  const auto direction = [](float degrees) {
    const float angle = degrees * static_cast<float>(M_PI) / 180;
    return Eigen::VectorXf(Eigen::Vector2f(std::cos(angle), std::sin(angle)));
  };
  DescriptorPool pool;
  CHECK(pool.similarities().empty());
  CHECK(pool.most_similar(2).empty());
  pool.add(direction(60));
  CHECK(pool.similarities().size() == 1);
  CHECK(pool.most_similar(2).empty());
  for (float degrees : {20.0f, 200.0f, 20.0f, 10.0f, 0.0f}) pool.add(direction(degrees));
  const std::vector<double> similarities = pool.similarities();
  REQUIRE(similarities.size() == 6);
  CHECK(similarities[0] == doctest::Approx(0.5));
  CHECK(similarities[2] == doctest::Approx(-std::cos(M_PI / 9)));
  CHECK(similarities[5] == doctest::Approx(1));
  CHECK(pool.most_similar(2) == std::vector<int>{3, 1});
  CHECK(pool.most_similar(9) == std::vector<int>{3, 1, 0});
  CHECK(pool.most_similar(0).empty());
  CHECK(pool.most_similar(-1).empty());
  pool.add(Eigen::VectorXf::Zero(2));
  CHECK(pool.most_similar(2).empty());
}

TEST_CASE("the window of descriptors takes keyframes that look alike, wherever they are thought to be") {
  const auto far_away = [](int k) {
    Keyframe keyframe;
    keyframe.camera.world_to_camera.translation().x() = 100 * k;
    return keyframe;
  };
  std::vector<Keyframe> keyframes;
  Covisibility vlad({.window = 3, .covisibility = CovisibilityKind::Vlad});
  Covisibility geometric({.window = 3});
  for (int k = 0; k < 6; ++k) {
    keyframes.push_back(far_away(k));
    const Frame frame = frame_of(view(wall(k == 1 || k == 5 ? 1 : 2), 20 * k));
    vlad.add(vlad.describe(frame));
    geometric.add(geometric.describe(frame));
  }
  CHECK(vlad.similar() == std::vector<int>{1});
  CHECK(geometric.similar().empty());
  CHECK(nearest_keyframes(keyframes, 3, vlad.similar()) == std::vector<int>{5, 4, 1});
  CHECK(nearest_keyframes(keyframes, 3) == std::vector<int>{5, 4, 3});
  CHECK(vlad.window(keyframes, {5, 4, 3, 1}).members == std::vector<int>{1, 4, 5});
  // Without images the overlap decides: these see no depth at all.
  CHECK(geometric.window(keyframes, {5, 4, 3, 1}).members == std::vector<int>{4, 5});
}

TEST_CASE("training finds the middles of clusters, the same each time, and stops when it is told to") {
  const LocalFeatures features = clustered_features();
  int rounds = 0;
  const auto train = [&](VocabularySettings settings) {
    rounds = 0;
    return train_vocabulary(features, settings, [&](int round) { return rounds = round, true; }).words;
  };
  const LocalFeatures words = train({.words = 3});
  CHECK(rounds >= 1);
  CHECK(rounds < 10);
  for (int cluster = 0; cluster < 3; ++cluster) {
    LocalFeatures middle = LocalFeatures::Zero(1, kFeatureSize);
    for (int i = cluster; i < 60; i += 3) middle += features.row(i) / 20;
    CHECK(nearest_word(words, middle.row(0)).distance < 1e-8f);
  }
  CHECK(train({.words = 3}) == words);
  CHECK(train({.words = 60}).rows() == 60);
  CHECK(contains(input_error([&] { train({.words = 61}); }), "--words"));
  rounds = 0;
  train_vocabulary(features, {.words = 8}, [&](int) { return ++rounds, false; });
  CHECK(rounds == 1);
}

TEST_CASE("a vocabulary file is read back to thousandths, and what is none is refused by name and line") {
  const TemporaryFolder folder;
  const Vocabulary trained = train_vocabulary(clustered_features(), {.words = 3}, [](int) { return true; });
  const auto file = folder.write("words.txt", vocabulary_text(trained, "three words"));
  const Vocabulary read = read_vocabulary(file);
  REQUIRE(read.words.rows() == 3);
  CHECK((read.words - trained.words).cwiseAbs().maxCoeff() < 0.00051f);
  CHECK(vocabulary_text(read, "three words") == read_file(file));

  CHECK(contains(input_error([&] { read_vocabulary(folder / "none.txt"); }), "none.txt"));
  const auto empty = folder.write("empty.txt", "# nothing\n");
  CHECK(contains(input_error([&] { read_vocabulary(empty); }), "empty.txt: holds no words"));
  const auto refused = [&](const std::string& line) {
    const auto wrong = folder.write("wrong.txt", "# words\n\n" + line + "\n");
    return contains(input_error([&] { read_vocabulary(wrong); }), "wrong.txt:3:");
  };
  std::string zeros;
  for (int i = 1; i < kFeatureSize; ++i) zeros += "0 ";
  CHECK(refused("1 2 3"));
  CHECK(refused(zeros + "many"));
  CHECK(refused(zeros + "1001"));
  CHECK(refused(zeros + "nan"));
  CHECK_FALSE(refused(zeros + "1000"));
}

TEST_CASE("the built-in vocabulary is the file of configs/, and another one can be named") {
  const Vocabulary words = read_vocabulary(SUREFIELD_SOURCE_DIR "/configs/vocabulary.txt");
  CHECK(built_in_vocabulary().words == words.words);
  const TemporaryFolder folder;
  const Vocabulary three = train_vocabulary(clustered_features(), {.words = 3}, [](int) { return true; });
  const auto file = folder.write("words.txt", vocabulary_text(three, "three words"));
  const auto own = make_descriptor({.covisibility = CovisibilityKind::Vlad, .vocabulary = file.string()});
  CHECK(own->describe(view(wall(1), 0)).size() == 3 * kFeatureSize);
  CHECK(make_descriptor({}) == nullptr);
}
