#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace surefield::test {

/// A node of a network: its operator, the values it reads and the one it writes, and its attributes that are
/// lists of integers, or one integer.
struct OnnxNode {
  std::string op;
  std::vector<std::string> inputs;
  std::string output;
  std::vector<std::pair<std::string, std::vector<int64_t>>> integers;
  std::vector<std::pair<std::string, int64_t>> numbers = {};
};

/// A constant of a network: floats, or integers where it has such.
struct OnnxTensor {
  std::string name;
  std::vector<int64_t> shape;
  std::vector<float> values;
  std::vector<int64_t> integers = {};
};

/// A network with float inputs of one shape and one output.
struct OnnxNetwork {
  std::vector<std::string> inputs;
  std::vector<int64_t> input_shape;
  std::vector<OnnxTensor> constants;
  std::vector<OnnxNode> nodes;  ///< the last one gives the output
  std::vector<int64_t> output_shape = {1, 1, 1, 1};
  std::vector<std::string> other_outputs = {};  ///< of other nodes, of the same shape
};

/// The network as the bytes of an ONNX file (opset 11): a protobuf message, written field by field.
std::string to_onnx(const OnnxNetwork& network);

}  // namespace surefield::test
