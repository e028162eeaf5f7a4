#include "engine/sources/plausibility.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace surefield {

namespace {

// Degrees. Depth cameras have 40 to 120; a telephoto lens and a fisheye's whole circle lie beyond.
constexpr double kNarrowest = 20;
constexpr double kWidest = 130;
constexpr double kCentreOff = 0.2;                             // of the image's side, from its middle
constexpr double kPixelShape = 1.9;                            // fx / fy, or fy / fx
constexpr double kNearestMedian = 0.15, kFarthestMedian = 30;  // metres
constexpr double kRoomNear = 0.4, kRoomFar = 8;                // metres; medians that a likely unit gives
constexpr double kMostHoles = 0.95;
constexpr double kMostBeyond = 0.75;
constexpr double kFullScale = 65535;  // the largest number of a 16-bit image

double degrees_of_view(double size, double focal) {
  return 2 * std::atan(size / (2 * focal)) * 180 / std::numbers::pi;
}

bool alike(double a, double b) {
  return std::abs(a - b) < 0.04 * b;
}

/// One side of the image against one focal length.
void judge_view(std::vector<std::string>& findings, const char* key, double focal, const char* side,
                int size) {
  const double view = degrees_of_view(size, focal);
  if (view >= kNarrowest && view <= kWidest) return;
  findings.push_back(
      fmt::format("{} {:.6g} for a {} of {} pixels is a field of view of {:.0f} degrees; do the intrinsics "
                  "belong to images "
                  "of this size?",
                  key, focal, side, size, view));
}

void judge_centre(std::vector<std::string>& findings, const char* key, double centre, const char* side,
                  int size) {
  const double middle = (size - 1) / 2.0;
  if (std::abs(centre - middle) <= kCentreOff * size) return;
  const bool outside = centre < 0 || centre > size - 1;
  findings.push_back(fmt::format(
      "{} {:.6g} lies {} (its middle is {:.6g}); do the intrinsics belong to images of {} {:.0f}?", key,
      centre,
      outside ? fmt::format("outside the image of {} {}", side, size)
              : fmt::format("far from the middle of the image of {} {}", side, size),
      middle, side, 2 * centre + 1));
}

/// The units, metres a step, in which depth is often stored, that give depths as of a room; empty where none
/// does.
std::string likely_units(const DepthRange& range, double depth_unit) {
  std::string text;
  for (double steps : {1000.0, 5000.0, 6553.5, 4000.0, 10000.0, 256.0, 100.0}) {
    const double median = range.median / depth_unit / steps;
    if (alike(1 / steps, depth_unit) || median < kRoomNear || median > kRoomFar) continue;
    text += fmt::format("{}1/{:g}", text.empty() ? "" : " or ", steps);
  }
  return text;
}

}  // namespace

std::string unit_text(double depth_unit) {
  const double steps = 1 / depth_unit;
  return steps >= 2 ? fmt::format("1/{:.6g}", steps) : fmt::format("{:.6g}", depth_unit);
}

std::vector<std::string> implausible(const Intrinsics& k) {
  std::vector<std::string> findings;
  if (!(k.fx > 0) || !(k.fy > 0) || k.width < 1 || k.height < 1) {
    return {
        fmt::format("fx {:g}, fy {:g} for {} x {} pixels are no camera's", k.fx, k.fy, k.width, k.height)};
  }
  judge_view(findings, "fx", k.fx, "width", k.width);
  judge_view(findings, "fy", k.fy, "height", k.height);
  if (k.width != k.height && alike(k.cx, k.height / 2.0) && alike(k.cy, k.width / 2.0)) {
    findings.push_back(fmt::format("cx {:.6g} and cy {:.6g} look swapped for {} x {} pixels", k.cx, k.cy,
                                   k.width, k.height));
  } else {
    judge_centre(findings, "cx", k.cx, "width", k.width);
    judge_centre(findings, "cy", k.cy, "height", k.height);
  }
  if (k.fx > kPixelShape * k.fy || k.fy > kPixelShape * k.fx) {
    findings.push_back(fmt::format("fx {:.6g} and fy {:.6g} would be pixels of a shape of 1 : {:.3g}", k.fx,
                                   k.fy, std::max(k.fx / k.fy, k.fy / k.fx)));
  }
  return findings;
}

std::vector<std::string> implausible(const DepthRange& range, double depth_unit, const DepthReach& reach) {
  std::vector<std::string> findings;
  const std::string read =
      fmt::format("1 to 99 % of the depths are {:.3g} to {:.3g} m", range.near, range.far);
  if (range.median < kNearestMedian || range.median > kFarthestMedian) {
    const std::string units = likely_units(range, depth_unit);
    findings.push_back(fmt::format("half of the depths are {} than {:.2g} m, {}: depth_unit is {} m{}",
                                   range.median < kNearestMedian ? "nearer" : "farther", range.median, read,
                                   unit_text(depth_unit),
                                   units.empty() ? "" : "; do the files use " + units + " m?"));
  } else if (range.beyond > kMostBeyond) {
    findings.push_back(
        fmt::format("{:.0f} % of the depths lie beyond depth_max, {:g} m, and will not be used ({}): "
                    "depth_max is too small, "
                    "or depth_unit, {} m, too large",
                    100 * range.beyond, reach.limit, read, unit_text(depth_unit)));
  } else if (range.far > reach.reach) {
    const std::string units = likely_units(range, depth_unit);
    findings.push_back(
        fmt::format("{}, farther than such a sensor measures: depth_unit is {} m{}; or say which sensor it "
                    "is (key sensor)",
                    read, unit_text(depth_unit), units.empty() ? "" : "; do the files use " + units + " m?"));
  }
  if (range.holes > kMostHoles) {
    findings.push_back(fmt::format("{:.1f} % of the pixels have no depth", 100 * range.holes));
  }
  if (range.far > 0.97 * kFullScale * depth_unit) {
    findings.push_back(
        fmt::format("1 % or more of the depths are {:.4g} m, the largest number that the images hold, which "
                    "often means that "
                    "nothing was measured; store 0 there",
                    kFullScale * depth_unit));
  }
  return findings;
}

}  // namespace surefield
