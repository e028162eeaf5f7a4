#include "engine/splat/densifier.h"

#include <algorithm>
#include <cmath>

#include "engine/gpu/recorder.h"

namespace surefield {

namespace {

std::vector<GaussianStatistics> read_statistics(const GaussianMap& map) {
  const auto logits = map.opacity_logits.value.download(map.size());
  const auto scales = map.log_scales.value.download(map.size());
  const auto gradients = map.densification.download(map.size());
  std::vector<GaussianStatistics> statistics(map.size());
  for (uint32_t i = 0; i < map.size(); ++i)
    statistics[i] = {.opacity = 1 / (1 + std::exp(-logits[i])),
                     .largest_scale = std::exp(std::max({scales[i].x, scales[i].y, scales[i].z})),
                     .screen_gradient = gradients[i].x / std::max(gradients[i].y, 1.0f)};
  return statistics;
}

}  // namespace

DensifyPlan plan_densification(std::span<const GaussianStatistics> statistics,
                               const DensifySettings& settings) {
  DensifyPlan plan;
  std::vector<uint32_t> clones, children;
  for (uint32_t i = 0; i < statistics.size(); ++i) {
    const GaussianStatistics& s = statistics[i];
    const bool keep =
        s.opacity >= settings.minimum_opacity && s.largest_scale <= settings.maximum_scale * settings.extent;
    if (!keep) {  // also where something is not a number
      ++plan.result.pruned;
      continue;
    }
    const bool grows = s.screen_gradient > settings.gradient_threshold;
    if (grows && s.largest_scale > settings.split_scale * settings.extent) {
      children.insert(children.end(), {i | glsl::SOURCE_SPLIT, i | glsl::SOURCE_SPLIT});
      ++plan.result.split;
      continue;
    }
    plan.sources.push_back(i | glsl::SOURCE_KEPT);
    if (grows) {
      clones.push_back(i | glsl::SOURCE_CLONE);
      ++plan.result.cloned;
    }
  }
  plan.sources.insert(plan.sources.end(), clones.begin(), clones.end());
  plan.sources.insert(plan.sources.end(), children.begin(), children.end());
  return plan;
}

Densifier::Densifier(gpu::Device& device)
    : device_(device), rebuild_(device), split_(device, gpu::kWorkgroup) {}

DensifyResult Densifier::densify(GaussianMap& map, const DensifySettings& settings) {
  const DensifyPlan plan = plan_densification(read_statistics(map), settings);
  rebuild_.rebuild(map, plan.sources);
  gpu::Recorder recorder(device_);
  recorder.fill(map.densification, map.size(), 0);
  recorder.dispatch(split_, split_.groups(map.size()),
                    {.sources = rebuild_.sources,
                     .means = map.means.value,
                     .log_scales = map.log_scales.value,
                     .rotations = map.rotations.value},
                    {.count = map.size(), .seed = static_cast<uint32_t>(settings.seed)});
  recorder.submit();
  return plan.result;
}

}  // namespace surefield
