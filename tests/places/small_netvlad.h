#pragma once

#include <string>
#include <vector>

#include "tests/support/onnx_writer.h"

namespace surefield::test {

inline constexpr int kNetVladWidth = 16, kNetVladHeight = 12;  // of the network's input
inline constexpr int kNetVladSize = 6;                         // of its output: 2 words of 3 channels

/// NetVLAD in miniature, with the layers of the real one: a convolution with ReLU and pooling gives local
/// features of 3 channels, brought to unit length; a 1 x 1 convolution with a softmax assigns them to 2
/// words; a matrix product adds up what they differ from the words' centres by; each word's sum and then the
/// whole are brought to unit length.
inline OnnxNetwork small_netvlad() {
  OnnxNetwork network;
  const int64_t cells = kNetVladWidth / 2 * kNetVladHeight / 2;
  network.inputs = {"image"};
  network.input_shape = {1, 3, kNetVladHeight, kNetVladWidth};
  network.output_shape = {1, kNetVladSize};
  network.constants = {{"filters", {3, 3, 1, 1}, {1, -1, 0, 0, 1, -1, -1, 0, 1}},
                       {"offsets", {3}, {0.1f, 0.2f, 0.3f}},
                       {"assigners", {2, 3, 1, 1}, {4, -2, 0, -3, 2, 1}},
                       {"biases", {2}, {0.5f, -0.5f}},
                       {"centres", {1, 2, 3}, {0.9f, 0.1f, 0.2f, 0.1f, 0.6f, 0.7f}},
                       {"tiny", {}, {1e-12f}},
                       {"ones", {cells, 3}, std::vector<float>(cells * 3, 1.0f)},
                       {"flat_words", {3}, {}, {1, 2, cells}},
                       {"flat_features", {3}, {}, {1, 3, cells}},
                       {"flat", {2}, {}, {1, kNetVladSize}}};
  std::vector<OnnxNode>& nodes = network.nodes;
  const auto unit_length = [&](const std::string& value, int64_t axis, const std::string& result) {
    nodes.push_back({"ReduceL2", {value}, result + "_length", {{"axes", {axis}}}});
    nodes.push_back({"Div", {value, result + "_length"}, result, {}});
  };
  nodes.push_back({"Conv", {"image", "filters", "offsets"}, "conv", {{"kernel_shape", {1, 1}}}});
  nodes.push_back({"Relu", {"conv"}, "relu", {}});
  nodes.push_back({"MaxPool", {"relu"}, "pool", {{"kernel_shape", {2, 2}}, {"strides", {2, 2}}}});
  unit_length("pool", 1, "features");
  nodes.push_back({"Conv", {"features", "assigners", "biases"}, "scores", {{"kernel_shape", {1, 1}}}});
  nodes.push_back({"Reshape", {"scores", "flat_words"}, "score_rows", {}});
  nodes.push_back({"Softmax", {"score_rows"}, "weights", {}, {{"axis", 1}}});
  nodes.push_back({"Reshape", {"features", "flat_features"}, "feature_rows", {}});
  nodes.push_back({"Transpose", {"feature_rows"}, "feature_columns", {{"perm", {0, 2, 1}}}});
  nodes.push_back({"MatMul", {"weights", "feature_columns"}, "sums", {}});
  nodes.push_back({"MatMul", {"weights", "ones"}, "shares", {}});
  nodes.push_back({"Mul", {"shares", "centres"}, "shift", {}});
  nodes.push_back({"Sub", {"sums", "shift"}, "residuals", {}});
  nodes.push_back({"Transpose", {"residuals"}, "residual_columns", {{"perm", {0, 2, 1}}}});
  unit_length("residual_columns", 1, "word_columns");
  nodes.push_back({"Transpose", {"word_columns"}, "words", {{"perm", {0, 2, 1}}}});
  nodes.push_back({"Reshape", {"words", "flat"}, "vlad", {}});
  unit_length("vlad", 1, "descriptor");
  return network;
}

}  // namespace surefield::test
