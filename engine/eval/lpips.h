#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace surefield {

/// The learned perceptual distance LPIPS, computed by a network that the user gives as an ONNX file; none is
/// shipped. The network has two inputs, `in0` and `in1`, each 1 x 3 x height x width, RGB in -1 to 1, and one
/// output whose mean is the distance. docs/evaluation.md tells how to make one.
class Lpips {
 public:
  /// Throws InputError when the file is missing or is no network that OpenCV can read.
  explicit Lpips(const std::filesystem::path& network);
  ~Lpips();

  /// The distance of two CV_32FC3 images (RGB, values in [0, 1]) of one size; 0 where they look the same.
  /// Throws InputError when the images do not match or the network does not take them.
  double distance(const cv::Mat& image, const cv::Mat& reference);

 private:
  struct Network;
  std::filesystem::path file_;
  std::unique_ptr<Network> network_;
};

}  // namespace surefield
