#include "engine/io/onnx_file.h"

#include <opencv2/core/utils/logger.hpp>
#include <optional>
#include <set>
#include <string_view>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

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

}  // namespace

std::string first_line(const cv::Exception& error) {
  const std::string text = error.err.empty() ? error.what() : error.err;
  return text.substr(0, text.find('\n'));
}

OnnxNetwork read_onnx(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
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
