#include "engine/eval/lpips.h"

#include <cmath>

#include "engine/io/onnx_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kFirstInput = "in0";
constexpr const char* kSecondInput = "in1";

/// 1 x 3 x height x width, values from -1 to 1.
cv::Mat to_blob(const cv::Mat& image) {
  cv::Mat centred;  // not left to blobFromImage: it would change the caller's pixels
  cv::subtract(image, cv::Scalar::all(0.5), centred);
  return cv::dnn::blobFromImage(centred * 2);
}

}  // namespace

struct Lpips::Network {
  cv::dnn::Net net;
};

Lpips::Lpips(const std::filesystem::path& network)
    : file_(network), network_(std::make_unique<Network>(Network{read_onnx(network).net})) {}

Lpips::~Lpips() = default;

double Lpips::distance(const cv::Mat& image, const cv::Mat& reference) {
  if (image.empty() || image.type() != CV_32FC3 || image.type() != reference.type() ||
      image.size() != reference.size()) {
    throw InputError("LPIPS needs two float images of three channels and one size");
  }
  cv::Mat result;
  try {
    network_->net.setInput(to_blob(image), kFirstInput);
    network_->net.setInput(to_blob(reference), kSecondInput);
    result = network_->net.forward();
  } catch (const cv::Exception& error) {
    throw InputError(file_, "does not take two images in0 and in1 of this size: " + first_line(error));
  }
  if (result.empty() || result.depth() != CV_32F) throw InputError(file_, "gives no 32-bit float output");
  const double distance = cv::mean(result.reshape(1, 1))[0];
  if (!std::isfinite(distance)) throw InputError(file_, "gives a distance that is not finite");
  return distance;
}

}  // namespace surefield
