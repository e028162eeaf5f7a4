#include "tools/results/trajectory_report.h"

#include <fmt/format.h>

#include <numbers>

namespace surefield {

nlohmann::ordered_json trajectory_json(const TrajectoryMetrics& metrics) {
  nlohmann::ordered_json json = {{"pairs", metrics.pairs},
                                 {"estimates", metrics.estimates},
                                 {"lost", metrics.lost},
                                 {"ate_rmse_m", metrics.ate.rmse},
                                 {"ate_mean_m", metrics.ate.mean},
                                 {"ate_median_m", metrics.ate.median},
                                 {"ate_max_m", metrics.ate.max},
                                 {"rpe_translation_rmse_m", metrics.rpe_frame.translation},
                                 {"rpe_rotation_rmse_rad", metrics.rpe_frame.rotation},
                                 {"rpe_1s_translation_rmse_m", nullptr},
                                 {"rpe_1s_rotation_rmse_rad", nullptr}};
  if (metrics.rpe_second.motions > 0) {
    json["rpe_1s_translation_rmse_m"] = metrics.rpe_second.translation;
    json["rpe_1s_rotation_rmse_rad"] = metrics.rpe_second.rotation;
  }
  return json;
}

nlohmann::ordered_json trajectory_json(const RunAccuracy& accuracy) {
  if (!accuracy.frames) return nullptr;
  nlohmann::ordered_json json = trajectory_json(*accuracy.frames);
  const auto add = [&](const char* key, const std::optional<TrajectoryMetrics>& metrics) {
    json[key] = metrics ? nlohmann::ordered_json(metrics->ate.rmse) : nlohmann::ordered_json(nullptr);
  };
  add("online_ate_rmse_m", accuracy.online);
  add("keyframes_ate_rmse_m", accuracy.keyframes);
  return json;
}

std::string trajectory_table(const TrajectoryMetrics& metrics) {
  const auto centimetres = [](double metres) { return 100 * metres; };
  const auto relative = [&](const char* title, const RelativeError& error) {
    return fmt::format("{:<16} {:.3f} cm, {:.4f} degrees\n", title, centimetres(error.translation),
                       error.rotation * 180 / std::numbers::pi);
  };
  std::string text;
  const std::string lost = metrics.lost > 0 ? fmt::format(", {} lost", metrics.lost) : "";
  text += fmt::format("poses compared   {} of {}{}\n", metrics.pairs, metrics.estimates, lost);
  text += fmt::format("ATE RMSE         {:.3f} cm   (mean {:.3f}, median {:.3f}, max {:.3f})\n",
                      centimetres(metrics.ate.rmse), centimetres(metrics.ate.mean),
                      centimetres(metrics.ate.median), centimetres(metrics.ate.max));
  if (metrics.rpe_frame.motions > 0) text += relative("RPE per frame", metrics.rpe_frame);
  if (metrics.rpe_second.motions > 0) text += relative("RPE per second", metrics.rpe_second);
  return text;
}

std::string trajectory_table(const RunAccuracy& accuracy) {
  std::string text = accuracy.frames ? trajectory_table(*accuracy.frames) : "";
  const auto add = [&](const char* name, const std::optional<TrajectoryMetrics>& metrics) {
    if (metrics) text += fmt::format("{:<16} {:.3f} cm\n", name, 100 * metrics->ate.rmse);
  };
  add("ATE, online", accuracy.online);
  add("keyframes' ATE", accuracy.keyframes);
  return text;
}

}  // namespace surefield
