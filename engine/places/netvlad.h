#pragma once

#include <filesystem>
#include <memory>

#include "engine/places/image_descriptor.h"

namespace surefield {

/// NetVLAD, or any other network that turns an image into a descriptor, from an ONNX file that the user
/// gives; none is shipped. Its one input is 1 x 3 x height x width with fixed sizes: RGB, less the mean
/// (0.485, 0.456, 0.406) and over the deviation (0.229, 0.224, 0.225) of values from 0 to 1; images are
/// resized to it. Its one output is the descriptor. docs/places.md tells how to make one.
class NetVladDescriptor : public ImageDescriptor {
 public:
  /// Reads the network and tries it on one image. Throws InputError where the file is missing, is no network
  /// that OpenCV can run, or is not of that form.
  explicit NetVladDescriptor(const std::filesystem::path& network);
  ~NetVladDescriptor() override;

  Eigen::VectorXf describe(const cv::Mat& rgb) override;

 private:
  struct Network;
  std::filesystem::path file_;
  std::unique_ptr<Network> network_;
};

}  // namespace surefield
