#include "engine/places/netvlad.h"

#include <opencv2/imgproc.hpp>

#include "engine/io/onnx_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

// Of the images that such networks are trained on; red, green, blue, values from 0 to 1.
const cv::Scalar kMean(0.485, 0.456, 0.406), kDeviation(0.229, 0.224, 0.225);

/// The size of the images that the network takes.
cv::Size input_size(const OnnxNetwork& network, const std::filesystem::path& file) {
  const std::vector<OnnxInput>& inputs = network.inputs;
  const std::vector<int64_t> shape = inputs.size() == 1 ? inputs[0].shape : std::vector<int64_t>();
  const auto is_side = [](int64_t size) { return size > 0 && size <= 4096; };
  if (shape.size() != 4 || shape[0] > 1 || shape[1] != 3 || !is_side(shape[2]) || !is_side(shape[3])) {
    throw InputError(file,
                     "is no network with one input of 1 x 3 x height x width of fixed sizes; docs/places.md "
                     "tells how to make one");
  }
  return {static_cast<int>(shape[3]), static_cast<int>(shape[2])};
}

/// An image with something to see, to try a network on.
cv::Mat pattern(cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      image.at<cv::Vec3b>(y, x) = {static_cast<uchar>(x * 37 + y * 11), static_cast<uchar>(x * y),
                                   static_cast<uchar>(x * 5 + y * 59)};
  return image;
}

}  // namespace

struct NetVladDescriptor::Network {
  cv::dnn::Net net;
  cv::Size size;
};

NetVladDescriptor::NetVladDescriptor(const std::filesystem::path& network) : file_(network) {
  OnnxNetwork onnx = read_onnx(network);
  const cv::Size size = input_size(onnx, file_);
  if (onnx.net.getUnconnectedOutLayersNames().size() != 1)
    throw InputError(file_, "has several outputs; docs/places.md tells how to make a network with one");
  network_ = std::make_unique<Network>(Network{std::move(onnx.net), size});
  if (describe(pattern(size)).isZero(0))
    throw InputError(file_, "gives values that are not finite, or nothing but zeros");
}

NetVladDescriptor::~NetVladDescriptor() = default;

Eigen::VectorXf NetVladDescriptor::describe(const cv::Mat& rgb) {
  cv::Mat resized, image, output;
  cv::resize(rgb, resized, network_->size, 0, 0, cv::INTER_AREA);
  resized.convertTo(image, CV_32FC3, 1.0 / 255);
  cv::subtract(image, kMean, image);
  cv::divide(image, kDeviation, image);
  try {
    network_->net.setInput(cv::dnn::blobFromImage(image));
    output = network_->net.forward();
  } catch (const cv::Exception& error) {
    throw InputError(file_, "cannot be run by OpenCV: " + first_line(error));
  }
  if (output.empty() || output.depth() != CV_32F || static_cast<std::size_t>(output.size[0]) != 1)
    throw InputError(file_, "gives no descriptor of 32-bit floats, 1 x length");
  const cv::Mat row = output.reshape(1, 1);
  Eigen::VectorXf descriptor = Eigen::Map<const Eigen::VectorXf>(row.ptr<float>(), row.cols);
  if (!descriptor.allFinite()) return Eigen::VectorXf::Zero(row.cols);
  descriptor.normalize();
  return descriptor;
}

}  // namespace surefield
