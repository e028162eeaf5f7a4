// What is said about each frame, in metrics.json and in frames.csv; docs/evaluation.md describes the columns.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "engine/session/frame_table.h"

namespace surefield {

namespace {

using Json = nlohmann::ordered_json;

/// A share or a gain with the digits that mean something.
double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

/// The upper triangle by rows, in one cell.
std::string covariance_text(const PoseCovariance& covariance) {
  std::string text;
  for (int row = 0; row < covariance.rows(); ++row)
    for (int column = row; column < covariance.cols(); ++column)
      text += fmt::format("{}{:.4g}", text.empty() ? "" : " ", covariance(row, column));
  return text;
}

}  // namespace

const char* name_of(TrackingState state) {
  switch (state) {
    case TrackingState::Good:
      return "good";
    case TrackingState::Poor:
      return "poor";
    default:
      return "lost";
  }
}

nlohmann::ordered_json frame_json(const FrameReport& frame) {
  return {{"index", frame.index},
          {"timestamp_s", frame.timestamp},
          {"keyframe", frame.keyframe},
          {"state", name_of(frame.state)},
          {"lost", frame.lost()},
          {"gain_red", rounded(frame.gains[0])},
          {"gain_green", rounded(frame.gains[1])},
          {"gain_blue", rounded(frame.gains[2])},
          {"retries", frame.retries},
          {"found_at", frame.found_at},
          {"loss", frame.tracking_loss},
          {"valid_fraction", frame.valid_fraction},
          {"explained", rounded(frame.explained)},
          {"seen_through", rounded(frame.seen_through)},
          {"moved", rounded(frame.moved)},
          {"sigma_cm", rounded(100 * position_sigma(frame.covariance))},
          {"sigma_deg", rounded(degrees(rotation_sigma(frame.covariance)))},
          {"covariance", covariance_text(frame.covariance)},
          {"tracking_iterations", frame.tracking_iterations},
          {"tracking_ms", frame.tracking_ms},
          {"mapping_iterations", frame.mapping_iterations},
          {"mapping_ms", frame.mapping_ms},
          {"loops_ms", frame.loops_ms},
          {"gaussians", frame.gaussians},
          {"uncertain_gaussians", frame.uncertain_gaussians},
          {"device_gaussians", frame.device_gaussians},
          {"device_mb", static_cast<double>(frame.device_bytes) / 1e6}};
}

std::string frames_csv(const std::vector<FrameReport>& frames) {
  std::string text;
  const auto add_line = [&](const Json& frame, auto&& cell) {
    const char* separator = "";
    for (const auto& column : frame.items()) {
      text += separator;
      text += cell(column);
      separator = ",";
    }
    text += "\n";
  };
  add_line(frame_json({}), [](const auto& column) { return column.key(); });
  for (const FrameReport& frame : frames) {
    add_line(frame_json(frame), [](const auto& column) {
      const Json& value = column.value();
      if (value.is_string()) return value.template get<std::string>();
      return value.is_boolean() ? std::string(value.template get<bool>() ? "1" : "0") : value.dump();
    });
  }
  return text;
}

}  // namespace surefield
