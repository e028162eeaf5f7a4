#include "engine/eval/lpips.h"

#include <doctest/doctest.h>

#include "tests/support/input_files.h"
#include "tests/support/onnx_writer.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr int kWidth = 6, kHeight = 4;

/// LPIPS in miniature, with all its kinds of operators: two features a pixel (red, and green + blue) with a
/// ReLU, scaled to length 1; differences squared and weighted by 0.5 and 0.25, averaged over the image.
/// `names` are those of the inputs.
std::string small_network(const std::vector<std::string>& names = {"in0", "in1"}) {
  OnnxNetwork network;
  network.inputs = names;
  network.input_shape = {1, 3, kHeight, kWidth};
  network.constants = {{"features", {2, 3, 1, 1}, {1, 0, 0, 0, 1, 1}},
                       {"weights", {1, 2, 1, 1}, {0.5f, 0.25f}},
                       {"epsilon", {}, {1e-10f}}};
  const std::pair<std::string, std::vector<int64_t>> kernel = {"kernel_shape", {1, 1}};
  for (const std::string i : {"0", "1"}) {
    const std::vector<OnnxNode> branch = {{"Conv", {names[i == "1"], "features"}, "conv" + i, {kernel}},
                                          {"Relu", {"conv" + i}, "relu" + i, {}},
                                          {"Mul", {"relu" + i, "relu" + i}, "square" + i, {}},
                                          {"ReduceSum", {"square" + i}, "sum" + i, {{"axes", {1}}}},
                                          {"Sqrt", {"sum" + i}, "root" + i, {}},
                                          {"Add", {"root" + i, "epsilon"}, "length" + i, {}},
                                          {"Div", {"relu" + i, "length" + i}, "unit" + i, {}}};
    network.nodes.insert(network.nodes.end(), branch.begin(), branch.end());
  }
  const std::vector<OnnxNode> end = {{"Sub", {"unit0", "unit1"}, "difference", {}},
                                     {"Mul", {"difference", "difference"}, "squared", {}},
                                     {"Conv", {"squared", "weights"}, "weighted", {kernel}},
                                     {"ReduceMean", {"weighted"}, "distance", {{"axes", {2, 3}}}}};
  network.nodes.insert(network.nodes.end(), end.begin(), end.end());
  return to_onnx(network);
}

cv::Mat image_of(double red, double green, double blue) {
  return {kHeight, kWidth, CV_32FC3, cv::Scalar(red, green, blue)};
}

}  // namespace

TEST_CASE("LPIPS feeds both images to the network: RGB, from -1 to 1") {
  const TemporaryFolder folder;
  Lpips lpips(folder.write("network.onnx", small_network()));
  const cv::Mat image = image_of(1, 0.75, 0.5);
  CHECK(lpips.distance(image, image) == 0);
  // Features (1, 0.5 + 0) / sqrt(1.25) and (0, 0): 0.5 * 1 / 1.25 + 0.25 * 0.25 / 1.25.
  CHECK(lpips.distance(image, image_of(0, 0, 0)) == doctest::Approx(0.45));
  CHECK(lpips.distance(image_of(0, 0, 0), image) == doctest::Approx(0.45));
  // One of 24 pixels turns black.
  cv::Mat spotted = image.clone();
  spotted.at<cv::Vec3f>(2, 3) = {0, 0, 0};
  CHECK(lpips.distance(spotted, image) == doctest::Approx(0.45 / 24));
  CHECK(cv::norm(image, image_of(1, 0.75, 0.5), cv::NORM_INF) == 0);
}

TEST_CASE("networks and images that LPIPS cannot use are refused by name") {
  const TemporaryFolder folder;
  CHECK(contains(input_error([&] { Lpips(folder / "none.onnx"); }), "none.onnx"));
  const auto broken = folder.write("broken.onnx", "no network at all");
  CHECK(contains(input_error([&] { Lpips{broken}; }), "broken.onnx"));
  OnnxNetwork huge;
  huge.inputs = {"in0", "in1"};
  huge.input_shape = {1, 3, kHeight, kWidth};
  huge.constants = {{"weights", {100000, 100000, 3, 3}, {1, 2}}};
  huge.nodes = {{"Conv", {"in0", "weights"}, "distance", {{"kernel_shape", {3, 3}}}}};
  const auto claims = folder.write("huge.onnx", to_onnx(huge));
  CHECK(contains(input_error([&] { Lpips{claims}; }), "its constant weights is to have 9e+10 values in "));
  const auto file = folder.write("names.onnx", small_network({"left", "right"}));
  const cv::Mat image = image_of(0, 0, 0);
  Lpips other(file);
  CHECK(contains(input_error([&] { other.distance(image, image); }), "in0 and in1"));
  Lpips lpips(folder.write("network.onnx", small_network()));
  CHECK_THROWS_AS(lpips.distance(image, cv::Mat(2, 2, CV_32FC3, cv::Scalar())), InputError);
  CHECK_THROWS_AS(lpips.distance(cv::Mat(), cv::Mat()), InputError);
}
