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
    : device_(device),
      gather_(device, gpu::kWorkgroup),
      split_(device, gpu::kWorkgroup),
      sources_(device, "sources") {}

template <class T>
void Densifier::gather(gpu::Recorder& recorder, gpu::Array<T>& array, uint32_t words, bool only_kept) {
  const uint64_t entries = static_cast<uint64_t>(new_size_) * words * sizeof(glsl::uint) / sizeof(T);
  gpu::Array<T> rebuilt(device_, array.buffer().name(), std::max(entries, array.capacity()));
  recorder.dispatch(gather_, gather_.groups(new_size_),
                    {.sources = sources_, .from = gpu::as_words(array), .to = gpu::as_words(rebuilt)},
                    {.count = new_size_, .words = words, .only_kept = only_kept ? 1u : 0u});
  recorder.replace(array, std::move(rebuilt));
}

template <class T>
void Densifier::gather_parameter(gpu::Recorder& recorder, Parameter<T>& parameter, uint32_t words) {
  gather(recorder, parameter.value, words, false);
  gather(recorder, parameter.first_moment, words, true);
  gather(recorder, parameter.second_moment, words, true);
}

DensifyResult Densifier::densify(GaussianMap& map, const DensifySettings& settings) {
  const DensifyPlan plan = plan_densification(read_statistics(map), settings);
  new_size_ = static_cast<uint32_t>(plan.sources.size());
  sources_.upload(plan.sources);
  gpu::Recorder recorder(device_);
  gather_parameter(recorder, map.means, 3);
  gather_parameter(recorder, map.log_scales, 3);
  gather_parameter(recorder, map.rotations, 4);
  gather_parameter(recorder, map.opacity_logits, 1);
  gather_parameter(recorder, map.sh, 3 * static_cast<uint32_t>(sh_coefficients(map.sh_degree())));
  gather(recorder, map.steps, 1, true);
  recorder.reserve(map.densification, map.steps.capacity());
  recorder.fill(map.densification, new_size_, 0);
  recorder.dispatch(split_, split_.groups(new_size_),
                    {.sources = sources_,
                     .means = map.means.value,
                     .log_scales = map.log_scales.value,
                     .rotations = map.rotations.value},
                    {.count = new_size_, .seed = static_cast<uint32_t>(settings.seed)});
  recorder.submit();
  map.set_size(new_size_);
  return plan.result;
}

}  // namespace surefield
