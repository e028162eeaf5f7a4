// What a check found, in words.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/eval/dataset_check.h"

namespace surefield {

namespace {

constexpr double kAlike = 0.05;  // relative difference of values that mean the same

const Judgement* wrong(const DatasetCheck& check, CheckedValue value) {
  const Judgement& judgement = check.judgements.at(static_cast<std::size_t>(value));
  return judgement.wrong ? &judgement : nullptr;
}

bool alike(double a, double b) {
  return std::abs(a / b - 1) < kAlike;
}

/// "1/5000", or the number where it is no such fraction of note.
std::string unit_text(double unit) {
  const double steps = 1 / unit;
  return steps >= 2 ? fmt::format("1/{:.6g}", steps) : fmt::format("{:.6g}", unit);
}

std::string depth_scale_text(double best, double unit) {
  std::string text =
      fmt::format("depth looks {:.3g} x too {}: depth_unit is {} m, {} would fit", best < 1 ? 1 / best : best,
                  best < 1 ? "large" : "small", unit_text(unit), unit_text(unit * best));
  for (double steps : {1000.0, 4000.0, 5000.0, 6553.5, 10000.0}) {
    if (!alike(1 / steps, unit * best)) continue;
    return text + fmt::format("; do the files use 1/{:g} m?", steps);
  }
  return text;
}

std::string focal_ratio_text(double best, const Intrinsics& k) {
  if (alike(best, k.fy / k.fx)) {
    return fmt::format("fx and fy look swapped: fx {:.6g}, fy {:.6g} would fit", k.fy, k.fx);
  }
  return fmt::format(
      "the pixels' shape does not fit: fx {:.4g}, fy {:.4g} would (given: {:.4g}, {:.4g}); were "
      "the images stretched?",
      k.fx * best, k.fy / best, k.fx, k.fy);
}

std::string focal_text(double best, const Intrinsics& k) {
  return fmt::format(
      "the focal lengths look {:.3g} x too {}: fx {:.4g}, fy {:.4g} would fit; do the intrinsics "
      "belong to this camera and to this image size?",
      best < 1 ? 1 / best : best, best < 1 ? "long" : "short", k.fx * best, k.fy * best);
}

std::string delay_text(double best, bool indices) {
  return indices ? fmt::format("{:.1f} frames", std::abs(best))
                 : fmt::format("{:.0f} ms", 1000 * std::abs(best));
}

/// Depth lies elsewhere in its image than what it belongs to in the colour image.
std::string registration_text(const DatasetCheck& check) {
  const Judgement* zoom = wrong(check, CheckedValue::DepthFocal);
  const Judgement* x = wrong(check, CheckedValue::DepthShiftX);
  const Judgement* y = wrong(check, CheckedValue::DepthShiftY);
  if (!zoom && !x && !y) return {};
  std::string text = "depth is not registered to colour: its edges fit when the depth image is";
  if (zoom) text += fmt::format(" scaled by {:.3g}", zoom->best);
  if (x || y) {
    text += fmt::format("{} shifted by {:.0f}, {:.0f} pixels", zoom ? " and" : "", x ? x->best : 0.0,
                        y ? y->best : 0.0);
  }
  return text + "; register it with the calibration of both cameras";
}

}  // namespace

std::vector<std::string> check_findings(const DatasetCheck& check, const Recording& recording) {
  std::vector<std::string> findings;
  if (const auto* scale = wrong(check, CheckedValue::DepthScale)) {
    findings.push_back(depth_scale_text(scale->best, recording.depth_unit()));
  }
  if (const auto* focal = wrong(check, CheckedValue::FocalLength)) {
    findings.push_back(focal_text(focal->best, recording.intrinsics()));
  }
  if (const auto* ratio = wrong(check, CheckedValue::FocalRatio)) {
    findings.push_back(focal_ratio_text(ratio->best, recording.intrinsics()));
  }
  const std::string registration = registration_text(check);
  if (!registration.empty()) findings.push_back(registration);
  if (const auto* delay = wrong(check, CheckedValue::PoseDelay)) {
    findings.push_back(fmt::format(
        "the images look taken {} {} than their stamps say, by the clock of the poses; "
        "correct one of the clocks",
        delay_text(delay->best, check.stamps_are_indices), delay->best > 0 ? "later" : "earlier"));
  }
  if (const auto* delay = wrong(check, CheckedValue::DepthDelay)) {
    findings.push_back(fmt::format(
        "depth looks taken {} {} than its stamps say, by the clock of the colour "
        "images; correct its stamps, or pair other images",
        delay_text(delay->best, check.stamps_are_indices), delay->best > 0 ? "later" : "earlier"));
  }
  return findings;
}

}  // namespace surefield
