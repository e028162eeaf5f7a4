#include "engine/formats/usable_gaussians.h"

#include <cmath>
#include <limits>
#include <vector>

#include "engine/formats/gaussian_order.h"

namespace surefield {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kOpaqueLogit = 20;    // the sigmoid is 1 in 32 bits
constexpr float kFlatLogScale = -20;  // two nanometres

}  // namespace

LeftOutGaussians keep_usable(GaussianCloud& cloud) {
  LeftOutGaussians left_out;
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    float& logit = cloud.opacity_logits[i];
    if (logit == -kInfinity) {
      ++left_out.invisible;
      continue;
    }
    if (logit == kInfinity) logit = kOpaqueLogit;
    for (float& value : cloud.log_scales[i])
      if (value == -kInfinity) value = kFlatLogScale;
    float& uncertainty = cloud.uncertainty[i];
    if (uncertainty == kInfinity) uncertainty = std::numeric_limits<float>::max();
    float& sampling = cloud.sampling[i];
    if (!(sampling >= 0 && std::isfinite(sampling))) sampling = 0;  // not known
    if (is_finite(cloud, i) && std::isfinite(uncertainty)) {
      usable.push_back(i);
    } else {
      ++left_out.broken;
    }
  }
  if (usable.size() < cloud.size()) cloud = select(cloud, usable);
  return left_out;
}

}  // namespace surefield
