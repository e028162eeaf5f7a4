#pragma once

#include <Eigen/Core>

namespace cv {
class Mat;
}

namespace surefield {

/// Turns an image into a vector such that images of one place have vectors of a similar direction.
class ImageDescriptor {
 public:
  virtual ~ImageDescriptor() = default;

  /// Describes an image (CV_8UC3, RGB) by a vector of unit length, or by zeros where it shows nothing to go
  /// by. All vectors of one describer have the same size. Throws InputError where the describer does not work
  /// on the image.
  virtual Eigen::VectorXf describe(const cv::Mat& rgb) = 0;
};

}  // namespace surefield
