#include "engine/slam/first_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr float kBlack = 12;                // of 255: the brightest channel of a cell that shows something
constexpr double kShowing = 0.01;           // of the image has to show something
constexpr double kSettled = 0.03;           // change of brightness from frame to frame of a settled exposure
constexpr int kMostWaited = 30;             // frames that a run waits for it: a second
constexpr std::size_t kFewestChanges = 40;  // pairs of cells to tell a change from

bool is_black(const ColourGrid& grid) {
  const auto showing = std::count_if(grid.colour.begin(), grid.colour.end(),
                                     [](const Eigen::Vector3f& mean) { return mean.maxCoeff() >= kBlack; });
  return static_cast<double>(showing) < kShowing * static_cast<double>(grid.colour.size());
}

bool is_white(const cv::Mat& colour) {
  const int pixels = colour.rows * colour.cols;
  int showing = 0;
  for (int i = 0; i < pixels; ++i) {
    const uint8_t* rgb = colour.ptr<uint8_t>() + 3 * static_cast<std::ptrdiff_t>(i);
    showing += std::min({rgb[0], rgb[1], rgb[2]}) < ColourGrid::kFull;
    if (showing >= kShowing * pixels) return false;
  }
  return true;
}

/// How much brighter a frame is than the one before it, the camera hardly having moved; none where too little
/// of either tells.
std::optional<double> brightening(const ColourGrid& before, const ColourGrid& now) {
  std::vector<float> logs;
  for (std::size_t i = 0; i < std::min(before.colour.size(), now.colour.size()); ++i)
    for (int c = 0; c < 3; ++c) {
      const float a = before.colour[i][c], b = now.colour[i][c];
      const bool tells = std::min(a, b) > 1 && std::max(a, b) >= kBlack;
      if (tells && std::max(before.peak[i][c], now.peak[i][c]) < ColourGrid::kFull)
        logs.push_back(std::log(b / a));
    }
  if (logs.size() < kFewestChanges) return std::nullopt;
  return std::exp(median(std::move(logs))) - 1;
}

}  // namespace

std::optional<std::string> FirstLight::objection(const Frame& frame, const ColourGrid& grid, bool begun) {
  const bool black = is_black(grid);
  if (black || is_white(frame.colour)) {
    blind_start_ = blind_start_ || !begun;
    return fmt::format("the image shows nothing: it is all {} (lens covered, no light, exposure not yet set)",
                       black ? "black" : "white");
  }
  if (begun || !blind_start_ || waited_ == kMostWaited) return std::nullopt;
  const auto change = last_ ? brightening(*last_, grid) : std::nullopt;
  if (change && std::abs(*change) <= kSettled) return std::nullopt;
  last_ = grid;
  ++waited_;
  if (!change)
    return "the camera's exposure may not have settled: no image before shows enough to compare with";
  return fmt::format("the camera's exposure has yet to settle: the image is {:.0f} % {} than the one before",
                     100 * std::abs(*change), *change > 0 ? "brighter" : "darker");
}

}  // namespace surefield
