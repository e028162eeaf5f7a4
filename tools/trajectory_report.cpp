#include "tools/trajectory_report.h"

#include <fmt/format.h>

#include <numbers>

namespace surefield {

nlohmann::ordered_json trajectory_json(const TrajectoryMetrics& metrics) {
  return {{"pairs", metrics.pairs},
          {"estimates", metrics.estimates},
          {"ate_rmse_m", metrics.ate.rmse},
          {"ate_mean_m", metrics.ate.mean},
          {"ate_median_m", metrics.ate.median},
          {"ate_max_m", metrics.ate.max},
          {"rpe_translation_rmse_m", metrics.rpe_translation},
          {"rpe_rotation_rmse_rad", metrics.rpe_rotation}};
}

std::string trajectory_table(const TrajectoryMetrics& metrics) {
  const auto centimetres = [](double metres) { return 100 * metres; };
  std::string text;
  text += fmt::format("poses compared   {} of {}\n", metrics.pairs, metrics.estimates);
  text += fmt::format("ATE RMSE         {:.3f} cm   (mean {:.3f}, median {:.3f}, max {:.3f})\n",
                      centimetres(metrics.ate.rmse), centimetres(metrics.ate.mean),
                      centimetres(metrics.ate.median), centimetres(metrics.ate.max));
  text += fmt::format("RPE per frame    {:.3f} cm, {:.4f} degrees\n", centimetres(metrics.rpe_translation),
                      metrics.rpe_rotation * 180 / std::numbers::pi);
  return text;
}

}  // namespace surefield
