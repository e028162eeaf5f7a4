#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace surefield::test {

/// A node of a network: its operator, the values it reads and the one it writes, and integer attributes.
struct OnnxNode {
  std::string op;
  std::vector<std::string> inputs;
  std::string output;
  std::vector<std::pair<std::string, std::vector<int64_t>>> integers;
};

/// A constant of a network.
struct OnnxTensor {
  std::string name;
  std::vector<int64_t> shape;
  std::vector<float> values;
};

/// A network with float inputs of one shape and one output.
struct OnnxNetwork {
  std::vector<std::string> inputs;
  std::vector<int64_t> input_shape;
  std::vector<OnnxTensor> constants;
  std::vector<OnnxNode> nodes;  ///< the last one gives the output
};

/// The network as the bytes of an ONNX file (opset 11): a protobuf message, written field by field.
std::string to_onnx(const OnnxNetwork& network);

}  // namespace surefield::test
