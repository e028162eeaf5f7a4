// What comparing the frames of a dataset says about its calibration, in words.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "engine/eval/verdicts.h"
#include "engine/sources/plausibility.h"

namespace surefield {

namespace {

constexpr double kAlike = 0.05;    // relative difference of values that mean the same
constexpr double kFewDegrees = 4;  // over a pair of frames: the camera hardly turns
constexpr int kFewPairs = 5;       // of frames that share points

bool alike(double a, double b) {
  return std::abs(a / b - 1) < kAlike;
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

std::string time_text(double delay, bool indices) {
  return indices ? fmt::format("{:.1f} frames", delay) : fmt::format("{:.0f} ms", 1000 * delay);
}

/// Words for one dataset.
class Writer {
 public:
  Writer(const DatasetCheck& check, const Recording& recording) : check_(check), recording_(recording) {}

  std::vector<Verdict> verdicts() const {
    return {depth_scale(), focal_length(), focal_ratio(), registration(), depth_delay(), pose_delay()};
  }

 private:
  const Judgement& of(CheckedValue value) const {
    return check_.judgements.at(static_cast<std::size_t>(value));
  }

  static std::string factor_text(const Judgement& judgement) {
    return fmt::format("x {:.3f} fits best, nothing between x {:.2f} and x {:.2f} clearly worse",
                       judgement.best, judgement.lower, judgement.upper);
  }

  std::string delay_text(const Judgement& judgement) const {
    const auto signed_text = [&](double delay) {
      return fmt::format("{}{}", delay < 0 ? "" : "+", time_text(delay, check_.stamps_are_indices));
    };
    return fmt::format("{} fits best, nothing between {} and {} clearly worse", signed_text(judgement.best),
                       signed_text(judgement.lower), signed_text(judgement.upper));
  }

  /// Why warping by true poses did not tell.
  std::string unposed_text() const {
    if (!check_.has_poses) return "it takes true poses";
    if (check_.error.pairs < 4) return "too few pairs of frames with true poses see the same from elsewhere";
    return "the camera's motion does not reveal it";
  }

  /// Why matched points did not tell either.
  std::string unmatched_text() const {
    const double degrees = check_.lens.turn * 180 / std::numbers::pi;
    if (check_.lens.pairs < kFewPairs) return "too few pairs of frames share enough points with depth";
    if (degrees < kFewDegrees) return fmt::format("the camera hardly turns, {:.1f} degrees at most", degrees);
    return fmt::format("{} pairs of frames do not agree well enough", check_.lens.pairs);
  }

  Verdict depth_scale() const {
    const Judgement& judgement = of(CheckedValue::DepthScale);
    if (judgement.wrong) {
      return {"depth_scale", Outcome::DoesNotFit, depth_scale_text(judgement.best, recording_.depth_unit())};
    }
    if (!judgement.judged) return {"depth_scale", Outcome::NotChecked, unposed_text()};
    return {"depth_scale", Outcome::Fits, factor_text(judgement)};
  }

  Verdict focal_length() const {
    const Judgement& judgement = of(CheckedValue::FocalLength);
    if (judgement.wrong) {
      return {"focal_length", Outcome::DoesNotFit, focal_text(judgement.best, recording_.intrinsics())};
    }
    if (!judgement.judged) return {"focal_length", Outcome::NotChecked, unmatched_text()};
    return {"focal_length", Outcome::Fits, factor_text(judgement)};
  }

  Verdict focal_ratio() const {
    const Judgement& judgement = of(CheckedValue::FocalRatio);
    if (judgement.wrong) {
      return {"focal_ratio", Outcome::DoesNotFit, focal_ratio_text(judgement.best, recording_.intrinsics())};
    }
    if (!judgement.judged) return {"focal_ratio", Outcome::NotChecked, unmatched_text()};
    return {"focal_ratio", Outcome::Fits, factor_text(judgement)};
  }

  /// Whether depth lies elsewhere in its image than what it belongs to in the colour image.
  Verdict registration() const {
    const Judgement &zoom = of(CheckedValue::DepthFocal), &x = of(CheckedValue::DepthShiftX),
                    &y = of(CheckedValue::DepthShiftY);
    if (zoom.wrong || x.wrong || y.wrong) {
      std::string text = "depth is not registered to colour: its edges fit when the depth image is";
      if (zoom.wrong) text += fmt::format(" scaled by {:.3g}", zoom.best);
      if (x.wrong || y.wrong) {
        text += fmt::format("{} shifted by {:.0f}, {:.0f} pixels", zoom.wrong ? " and" : "",
                            x.wrong ? x.best : 0.0, y.wrong ? y.best : 0.0);
      }
      return {"registration", Outcome::DoesNotFit,
              text + "; register it with the calibration of both cameras"};
    }
    if (!zoom.judged || !x.judged || !y.judged) {
      return {"registration", Outcome::NotChecked, "too few edges of depth lie on edges of colour"};
    }
    return {
        "registration", Outcome::Fits,
        fmt::format(
            "depth edges lie on colour edges, best when depth is scaled by {:.3f} or shifted by {:.1f} or "
            "{:.1f} pixels",
            zoom.best, x.best, y.best)};
  }

  Verdict depth_delay() const {
    const Judgement& judgement = of(CheckedValue::DepthDelay);
    if (judgement.wrong) {
      return {"depth_delay", Outcome::DoesNotFit,
              fmt::format(
                  "depth looks taken {} {} than its stamps say, by the clock of the colour images; correct "
                  "its stamps, or pair other images",
                  time_text(std::abs(judgement.best), check_.stamps_are_indices),
                  judgement.best > 0 ? "later" : "earlier")};
    }
    if (!judgement.judged) {
      return {"depth_delay", Outcome::NotChecked,
              "depth edges before and after fit as well: too little motion, or too few edges"};
    }
    const char* corrected = has_depth_stamps(recording_) ? "; surefield run corrects it" : "";
    return {"depth_delay", Outcome::Fits, delay_text(judgement) + corrected};
  }

  Verdict pose_delay() const {
    const Judgement& judgement = of(CheckedValue::PoseDelay);
    if (judgement.wrong) {
      return {"pose_delay", Outcome::DoesNotFit,
              fmt::format(
                  "the images look taken {} {} than their stamps say, by the clock of the poses; correct one "
                  "of the clocks",
                  time_text(std::abs(judgement.best), check_.stamps_are_indices),
                  judgement.best > 0 ? "later" : "earlier")};
    }
    if (!judgement.judged) return {"pose_delay", Outcome::NotChecked, unposed_text()};
    return {"pose_delay", Outcome::Fits, delay_text(judgement)};
  }

  const DatasetCheck& check_;
  const Recording& recording_;
};

}  // namespace

std::vector<Verdict> check_verdicts(const DatasetCheck& check, const Recording& recording) {
  return Writer(check, recording).verdicts();
}

}  // namespace surefield
