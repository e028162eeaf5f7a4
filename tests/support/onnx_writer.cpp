#include "tests/support/onnx_writer.h"

#include <cstring>

namespace surefield::test {

namespace {

constexpr int kFloat = 1;      // TensorProto.DataType
constexpr int kInt64 = 7;      // the same
constexpr int kInt = 2;        // AttributeProto.AttributeType
constexpr int kInts = 7;       // the same
constexpr int kIrVersion = 6;  // of the format
constexpr int kOpsetVersion = 11;

/// A protobuf message being written. Field numbers are those of onnx.proto.
class Message {
 public:
  Message& number(int field, int64_t value) {
    key(field, 0);
    varint(static_cast<uint64_t>(value));
    return *this;
  }
  Message& text(int field, const std::string& value) {
    key(field, 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  Message& message(int field, const Message& value) { return text(field, value.bytes_); }

  const std::string& bytes() const { return bytes_; }

 private:
  void key(int field, int wire_type) { varint(static_cast<uint64_t>(field << 3 | wire_type)); }
  void varint(uint64_t value) {
    for (; value >= 128; value >>= 7) bytes_ += static_cast<char>((value & 127) | 128);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

Message value_info(const std::string& name, const std::vector<int64_t>& shape) {
  Message dimensions;
  for (int64_t size : shape) dimensions.message(1, Message().number(1, size));
  const Message tensor = Message().number(1, kFloat).message(2, dimensions);
  return Message().text(1, name).message(2, Message().message(1, tensor));
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string raw(values.size() * sizeof(T), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return raw;
}

Message constant(const OnnxTensor& tensor) {
  Message message;
  for (int64_t size : tensor.shape) message.number(1, size);
  const bool whole = !tensor.integers.empty();
  const std::string raw = whole ? bytes_of(tensor.integers) : bytes_of(tensor.values);
  return message.number(2, whole ? kInt64 : kFloat).text(8, tensor.name).text(9, raw);
}

Message node(const OnnxNode& node) {
  Message message;
  for (const std::string& input : node.inputs) message.text(1, input);
  message.text(2, node.output).text(3, node.output).text(4, node.op);
  for (const auto& [name, values] : node.integers) {
    Message attribute;
    attribute.text(1, name);
    for (int64_t value : values) attribute.number(8, value);
    message.message(5, attribute.number(20, kInts));
  }
  for (const auto& [name, value] : node.numbers)
    message.message(5, Message().text(1, name).number(3, value).number(20, kInt));
  return message;
}

}  // namespace

std::string to_onnx(const OnnxNetwork& network) {
  Message graph;
  for (const OnnxNode& each : network.nodes) graph.message(1, node(each));
  graph.text(2, "network");
  for (const OnnxTensor& each : network.constants) graph.message(5, constant(each));
  for (const std::string& name : network.inputs) graph.message(11, value_info(name, network.input_shape));
  graph.message(12, value_info(network.nodes.back().output, network.output_shape));
  for (const std::string& name : network.other_outputs)
    graph.message(12, value_info(name, network.output_shape));
  const Message opset = Message().text(1, "").number(2, kOpsetVersion);
  return Message().number(1, kIrVersion).message(7, graph).message(8, opset).bytes();
}

}  // namespace surefield::test
