#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

namespace surefield {

/// An input that a network in an ONNX file declares.
struct OnnxInput {
  std::string name;
  std::vector<int64_t> shape;  ///< 0 where the size is left open
};

/// A network that the user gives.
struct OnnxNetwork {
  cv::dnn::Net net;
  std::vector<OnnxInput> inputs;  ///< without those that only carry constants
};

/// Reads an ONNX file. Throws InputError where it is missing or is no network that OpenCV can read.
OnnxNetwork read_onnx(const std::filesystem::path& file);

/// The first line of what OpenCV says; the others name its source files.
std::string first_line(const cv::Exception& error);

}  // namespace surefield
