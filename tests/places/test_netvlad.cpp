#include "engine/places/netvlad.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/slam/covisibility.h"
#include "tests/places/small_netvlad.h"
#include "tests/support/input_files.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// An image of the network's size with something to see.
cv::Mat image() {
  cv::Mat image(kNetVladHeight, kNetVladWidth, CV_8UC3);
  for (int y = 0; y < kNetVladHeight; ++y)
    for (int x = 0; x < kNetVladWidth; ++x)
      image.at<cv::Vec3b>(y, x) = {static_cast<uchar>(12 * x), static_cast<uchar>(20 * y),
                                   static_cast<uchar>((x * y * 7) % 256)};
  return image;
}

/// What small_netvlad() computes, in plain C++ and double precision.
std::array<double, kNetVladSize> reference(const cv::Mat& rgb) {
  constexpr double kFilters[3][3] = {{1, -1, 0}, {0, 1, -1}, {-1, 0, 1}}, kOffsets[3] = {0.1, 0.2, 0.3};
  constexpr double kAssigners[2][3] = {{4, -2, 0}, {-3, 2, 1}}, kBiases[2] = {0.5, -0.5};
  constexpr double kCentres[2][3] = {{0.9, 0.1, 0.2}, {0.1, 0.6, 0.7}};
  constexpr double kMean[3] = {0.485, 0.456, 0.406}, kDeviation[3] = {0.229, 0.224, 0.225};
  std::array<double, kNetVladSize> sums{};
  for (int cell = 0; cell < kNetVladWidth * kNetVladHeight / 4; ++cell) {
    Eigen::Vector3d feature = Eigen::Vector3d::Zero();
    for (int pixel = 0; pixel < 4; ++pixel) {
      const int x = cell % (kNetVladWidth / 2) * 2 + pixel % 2,
                y = cell / (kNetVladWidth / 2) * 2 + pixel / 2;
      for (int c = 0; c < 3; ++c) {
        double value = kOffsets[c];
        for (int k = 0; k < 3; ++k)
          value += kFilters[c][k] * (rgb.at<cv::Vec3b>(y, x)[k] / 255.0 - kMean[k]) / kDeviation[k];
        feature[c] = std::max(feature[c], value);
      }
    }
    feature.normalize();
    double weights[2], total = 0;
    for (int word = 0; word < 2; ++word) {
      const Eigen::Vector3d assigner(kAssigners[word]);
      total += weights[word] = std::exp(assigner.dot(feature) + kBiases[word]);
    }
    for (int i = 0; i < kNetVladSize; ++i)
      sums[static_cast<std::size_t>(i)] += weights[i / 3] / total * (feature[i % 3] - kCentres[i / 3][i % 3]);
  }
  for (std::size_t word = 0; word < 2; ++word) {
    const double length = std::hypot(sums[3 * word], sums[3 * word + 1], sums[3 * word + 2]);
    for (std::size_t i = 3 * word; i < 3 * word + 3; ++i) sums[i] /= length * std::sqrt(2);
  }
  return sums;
}

/// A network that takes an input of that shape and gives zeros.
OnnxNetwork zeros(const std::vector<int64_t>& shape) {
  OnnxNetwork network;
  network.inputs = {"image"};
  network.input_shape = network.output_shape = shape;
  network.nodes = {{"Sub", {"image", "image"}, "out", {}}};
  return network;
}

}  // namespace

TEST_CASE("a network of NetVLAD's layers gives what they compute, of RGB normalised as in training") {
  const TemporaryFolder folder;
  NetVladDescriptor network(folder.write("small.onnx", to_onnx(small_netvlad())));
  const Eigen::VectorXf descriptor = network.describe(image());
  const auto expected = reference(image());
  REQUIRE(descriptor.size() == kNetVladSize);
  for (int i = 0; i < kNetVladSize; ++i)
    CHECK(descriptor[i] == doctest::Approx(expected[static_cast<std::size_t>(i)]).epsilon(1e-4));
  CHECK(descriptor == network.describe(image()));
  // Larger images are reduced to the network's size.
  cv::Mat doubled(2 * kNetVladHeight, 2 * kNetVladWidth, CV_8UC3);
  for (int y = 0; y < doubled.rows; ++y)
    for (int x = 0; x < doubled.cols; ++x) doubled.at<cv::Vec3b>(y, x) = image().at<cv::Vec3b>(y / 2, x / 2);
  CHECK((network.describe(doubled) - descriptor).norm() < 1e-5f);
}

TEST_CASE("files that are no such network are refused by name") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name, const OnnxNetwork& network) {
    const auto file = folder.write(name, to_onnx(network));
    const std::string message = input_error([&] { NetVladDescriptor{file}; });
    CHECK(contains(message, name));
    return message;
  };
  CHECK(contains(input_error([&] { NetVladDescriptor(folder / "none.onnx"); }), "none.onnx"));
  const auto broken = folder.write("broken.onnx", "no network at all");
  CHECK(contains(input_error([&] { NetVladDescriptor{broken}; }), "broken.onnx"));
  CHECK(contains(error("grey.onnx", zeros({1, 1, 12, 16})), "3 x height x width"));
  CHECK(contains(error("flat.onnx", zeros({1, 3, 12})), "3 x height x width"));
  CHECK(contains(error("open.onnx", zeros({1, 3, 0, 16})), "fixed sizes"));
  CHECK(contains(error("zeros.onnx", zeros({1, 3, 12, 16})), "nothing but zeros"));
  OnnxNetwork two = small_netvlad();
  two.inputs.push_back("other");
  CHECK(contains(error("two.onnx", two), "one input"));
  OnnxNetwork several = small_netvlad();
  several.other_outputs = {"residuals"};
  CHECK(contains(error("several.onnx", several), "outputs"));
}

TEST_CASE("netvlad without a network says what to do, and with one it fills the pool") {
  const KeyframeSettings nameless{.covisibility = CovisibilityKind::NetVlad};
  CHECK(contains(input_error([&] { Covisibility{nameless}; }), "keyframes.netvlad"));
  const TemporaryFolder folder;
  const auto file = folder.write("small.onnx", to_onnx(small_netvlad()));
  Covisibility covisibility({.covisibility = CovisibilityKind::NetVlad, .netvlad = file.string()});
  for (int i = 0; i < 3; ++i) covisibility.add(covisibility.describe({.colour = image()}));
  CHECK(covisibility.similar() == std::vector<int>{0});
}
