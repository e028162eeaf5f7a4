#pragma once

#include "engine/places/image_descriptor.h"
#include "engine/places/vocabulary.h"

namespace surefield {

/// VLAD of features that have been found; see VladDescriptor.
Eigen::VectorXf vlad_of(const LocalFeatures& features, const Vocabulary& vocabulary);

/// VLAD (vector of locally aggregated descriptors) over RootSIFT: for each word, the sum of what the features
/// nearest to it differ from it by, brought to unit length; all of them one after the other, brought to unit
/// length. Needs no network and no download.
class VladDescriptor : public ImageDescriptor {
 public:
  explicit VladDescriptor(Vocabulary vocabulary) : vocabulary_(std::move(vocabulary)) {}

  Eigen::VectorXf describe(const cv::Mat& rgb) override;

 private:
  Vocabulary vocabulary_;
};

}  // namespace surefield
