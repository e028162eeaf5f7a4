#include "engine/io/onnx_file.h"

#include <fmt/format.h>

#include <opencv2/core/utils/logger.hpp>
#include <optional>
#include <set>
#include <string_view>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kMostPerByte = 2;  // values; those of 4 bits are the smallest that ONNX knows

/// A field of a protobuf message: a number, or bytes (text, or a message of its own).
struct Field {
  int number = 0;
  uint64_t value = 0;
  std::string_view bytes;
};

/// Takes fields off the front of a message.
class Message {
 public:
  explicit Message(std::string_view bytes) : rest_(bytes) {}

  /// nullopt at the end, and where the message is damaged.
  std::optional<Field> next() {
    const uint64_t key = varint();
    Field field{static_cast<int>(key >> 3)};
    std::size_t size = 0;
    switch (key & 7) {
      case 0:
        field.value = varint();
        break;
      case 1:
        size = 8;
        break;
      case 2:
        size = varint();
        break;
      case 5:
        size = 4;
        break;
      default:
        damaged_ = true;
    }
    if (damaged_ || size > rest_.size()) return std::nullopt;
    field.bytes = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return field;
  }

  /// A number of a packed field; nullopt as above.
  std::optional<uint64_t> number() {
    const uint64_t value = varint();
    return damaged_ ? std::nullopt : std::optional(value);
  }

 private:
  uint64_t varint() {
    uint64_t value = 0;
    for (int shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      value |= static_cast<uint64_t>(byte & 127) << shift;
      if (byte < 128) return value;
    }
    damaged_ = true;
    return 0;
  }

  std::string_view rest_;
  bool damaged_ = false;
};

/// The fields of a message that have that number.
std::vector<Field> fields(std::string_view message, int number) {
  std::vector<Field> found;
  Message rest(message);
  while (const auto field = rest.next())
    if (field->number == number) found.push_back(*field);
  return found;
}

/// The first of them; empty where there is none.
std::string_view field(std::string_view message, int number) {
  const std::vector<Field> found = fields(message, number);
  return found.empty() ? std::string_view() : found.front().bytes;
}

/// Field numbers here and below are those of onnx.proto: of a ValueInfoProto the name is 1, the type 2, of
/// that the tensor 1, of that the shape 2, of that the dimensions 1, of each its size 1.
OnnxInput parse_input(std::string_view value_info) {
  OnnxInput input{std::string(field(value_info, 1)), {}};
  for (const Field& dimension : fields(field(field(field(value_info, 2), 1), 2), 1)) {
    const std::vector<Field> size = fields(dimension.bytes, 1);
    input.shape.push_back(size.empty() ? 0 : static_cast<int64_t>(size.front().value));
  }
  return input;
}

/// Of a ModelProto the graph is 7, of that the constants 5, whose names are 8, and the inputs 11.
std::vector<OnnxInput> parse_inputs(std::string_view model) {
  const std::string_view graph = field(model, 7);
  std::set<std::string> constants;
  for (const Field& constant : fields(graph, 5)) constants.emplace(field(constant.bytes, 8));
  std::vector<OnnxInput> inputs;
  for (const Field& each : fields(graph, 11)) {
    OnnxInput input = parse_input(each.bytes);
    if (!constants.contains(input.name)) inputs.push_back(std::move(input));
  }
  return inputs;
}

/// The numbers of a repeated field, which may stand one by one or packed into one run of bytes.
std::vector<uint64_t> numbers(std::string_view message, int number) {
  std::vector<uint64_t> found;
  for (const Field& each : fields(message, number)) {
    if (each.bytes.empty()) {
      found.push_back(each.value);
    } else {
      for (Message packed(each.bytes); const auto value = packed.number();) found.push_back(*value);
    }
  }
  return found;
}

/// Of a TensorProto the sizes are 1, and its values, whatever their type, are in the message itself, unless
/// they are in another file (14). OpenCV takes memory, and reads, for as many as the sizes say.
void check_tensor(const std::filesystem::path& file, std::string_view tensor) {
  if (!numbers(tensor, 14).empty()) return;
  double values = 1;
  for (uint64_t size : numbers(tensor, 1)) values *= static_cast<double>(static_cast<int64_t>(size));
  if (values < 0 || values > kMostPerByte * static_cast<double>(tensor.size())) {
    throw InputError(file, fmt::format("is damaged: its constant {} is to have {:g} values in {} bytes",
                                       field(tensor, 8), values, tensor.size()));
  }
}

/// Checks the constants (5) of a graph, and those (of attributes, 5) that its nodes (1) carry.
void check_tensors(const std::filesystem::path& file, std::string_view model) {
  const std::string_view graph = field(model, 7);
  for (const Field& constant : fields(graph, 5)) check_tensor(file, constant.bytes);
  for (const Field& node : fields(graph, 1))
    for (const Field& attribute : fields(node.bytes, 5))
      for (const Field& tensor : fields(attribute.bytes, 5)) check_tensor(file, tensor.bytes);
}

}  // namespace

std::string first_line(const cv::Exception& error) {
  const std::string text = error.err.empty() ? error.what() : error.err;
  return text.substr(0, text.find('\n'));
}

OnnxNetwork read_onnx(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  check_tensors(file, bytes);
  OnnxNetwork network;
  // OpenCV would print what it throws as well.
  const auto level = cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    network.net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
  } catch (const cv::Exception& error) {
    cv::utils::logging::setLogLevel(level);
    throw InputError(file, "is no ONNX network that OpenCV can read: " + first_line(error));
  }
  cv::utils::logging::setLogLevel(level);
  if (network.net.empty()) throw InputError(file, "holds no ONNX network");
  network.inputs = parse_inputs(bytes);
  return network;
}

}  // namespace surefield
