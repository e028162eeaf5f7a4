#include "engine/types/gaussian_cloud.h"

namespace surefield {

bool GaussianCloud::is_consistent() const {
  return log_scales.size() == size() && rotations.size() == size() && opacity_logits.size() == size() &&
         uncertainty.size() == size() && sampling.size() == size() && anchors.size() == size() &&
         sh.size() == size() * static_cast<std::size_t>(sh_coefficients(sh_degree)) * 3;
}

void GaussianCloud::resize(std::size_t count) {
  means.resize(count, Eigen::Vector3f::Zero());
  log_scales.resize(count, Eigen::Vector3f::Zero());
  rotations.resize(count, Eigen::Vector4f(1, 0, 0, 0));
  opacity_logits.resize(count, 0.0f);
  sh.resize(count * static_cast<std::size_t>(sh_coefficients(sh_degree)) * 3, 0.0f);
  uncertainty.resize(count, 0.0f);
  sampling.resize(count, 0.0f);
  anchors.resize(count, 0);
}

}  // namespace surefield
