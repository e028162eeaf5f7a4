#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace surefield {

/// The length of a local feature's descriptor.
inline constexpr int kFeatureSize = 128;

/// Descriptors of local features, a row each.
using LocalFeatures = Eigen::Matrix<float, Eigen::Dynamic, kFeatureSize, Eigen::RowMajor>;

/// The same in bytes, a quarter of the size, as keyframes keep them.
using FeatureBytes = Eigen::Matrix<uint8_t, Eigen::Dynamic, kFeatureSize, Eigen::RowMajor>;

/// Descriptors of root_sift() in steps of 1 / 512 (what is above a half, which nothing is that has detail, is
/// cut there), and back: rows of unit length again.
FeatureBytes to_bytes(const LocalFeatures& features);
LocalFeatures to_floats(const FeatureBytes& features);

/// Features of an image and where they are.
struct ImageFeatures {
  LocalFeatures descriptors;
  std::vector<Eigen::Vector2f> pixels;  ///< of the image as it was given
};

/// RootSIFT of the image's SIFT features (CV_8UC3, RGB): descriptors divided by their sum, and the root taken
/// of each number, so that their scalar product is Hellinger's kernel of the histograms; rows of unit length.
/// Images are reduced to 320 pixels width first. No rows where nothing stands out. Does not depend on the
/// number of threads.
ImageFeatures find_features(const cv::Mat& rgb);
/// Their descriptors.
inline LocalFeatures root_sift(const cv::Mat& rgb) {
  return find_features(rgb).descriptors;
}

}  // namespace surefield
