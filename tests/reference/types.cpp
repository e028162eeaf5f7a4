#include "tests/reference/types.h"

#include <cmath>

namespace surefield::reference {

namespace {

std::size_t pixel_count(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

std::vector<double> to_double(const std::vector<float>& values) {
  return {values.begin(), values.end()};
}

}  // namespace

Gaussians::Gaussians(const GaussianCloud& cloud)
    : opacity_logits(to_double(cloud.opacity_logits)),
      sh_degree(cloud.sh_degree),
      sh(to_double(cloud.sh)),
      sampling(to_double(cloud.sampling)) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    means.push_back(cloud.means[i].cast<double>());
    log_scales.push_back(cloud.log_scales[i].cast<double>());
    rotations.push_back(cloud.rotations[i].cast<double>());
  }
}

Images::Images(int image_width, int image_height) : width(image_width), height(image_height) {
  const std::size_t pixels = pixel_count(width, height);
  colour.resize(pixels * 3);
  for (auto* image : {&opacity, &depth, &depth_normalised, &depth_median, &uncertainty, &dominator_weight}) {
    image->resize(pixels);
  }
  dominator.resize(pixels, -1);
  for (auto* flags : {&blend_edge, &median_edge, &dominator_edge, &on_edge}) flags->resize(pixels);
}

Images::Images(const RenderImages& images) : Images(images.width, images.height) {
  colour = to_double(images.colour);
  opacity = to_double(images.opacity);
  depth = to_double(images.depth);
  depth_normalised = to_double(images.depth_normalised);
  depth_median = to_double(images.depth_median);
  uncertainty = to_double(images.uncertainty);
  dominator = images.dominator;
  dominator_weight = to_double(images.dominator_weight);
}

ImageGradients::ImageGradients(int image_width, int image_height) : width(image_width), height(image_height) {
  const std::size_t pixels = pixel_count(width, height);
  colour.resize(pixels * 3);
  for (auto* image : {&opacity, &depth, &depth_normalised, &depth_median, &uncertainty})
    image->resize(pixels);
}

bool valid_depth(float depth) {
  return std::isfinite(depth) && depth > 0;
}

}  // namespace surefield::reference
