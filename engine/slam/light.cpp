#include "engine/slam/light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace surefield {

namespace {

constexpr float kDarkCell = 8;             // cells below, of 255, are noise for the most part
constexpr float kSamePlace = 0.05f;        // difference of depths, over the depth
constexpr std::size_t kFewestRatios = 40;  // pairs of cells to tell a gain from
constexpr int kRoundsOfShift = 4;
constexpr float kShown = 0.9f;                         // rendered opacity from which the map shows a surface
constexpr float kHarmonicBase = 0.28209479177387814f;  // the SH basis function of degree 0

/// What two images show of one place in a channel: the means and the peaks of cells, 0 to 255.
struct CellPair {
  float reference = 0;
  float reference_peak = 0;
  float frame = 0;
  float frame_peak = 0;
  float reference_gain = 1;  ///< times which the reference has the exposure of the map
};
using CellPairs = std::array<std::vector<CellPair>, 3>;

/// The corner of the four cells around a place of the grid, and how far it is from there.
struct Corner {
  int x = 0, y = 0;
  float right = 0, down = 0;
};

std::optional<Corner> corner_of(const ColourGrid& grid, double x, double y) {
  const double x0 = std::floor(x), y0 = std::floor(y);
  if (!(x0 >= 0 && y0 >= 0 && x0 + 1 < grid.width && y0 + 1 < grid.height)) return std::nullopt;
  return Corner{static_cast<int>(x0), static_cast<int>(y0), static_cast<float>(x - x0),
                static_cast<float>(y - y0)};
}

/// Their four values.
template <typename T>
std::array<T, 4> around(const ColourGrid& grid, const std::vector<T>& values, const Corner& at) {
  const std::size_t i = static_cast<std::size_t>(at.y) * grid.width + at.x;
  return {values[i], values[i + 1], values[i + grid.width], values[i + grid.width + 1]};
}

Eigen::Vector3f peak_of(const std::array<Eigen::Vector3f, 4>& v) {
  return v[0].cwiseMax(v[1]).cwiseMax(v[2]).cwiseMax(v[3]);
}

/// Lays the cells of a keyframe that have depth on where the frame shows them. Peaks are of as many cells on
/// either side, so that neither is left out more readily.
void compare(const ColourGrid& frame, const Camera& camera, const LitView& reference, CellPairs& pairs) {
  const ColourGrid& grid = reference.grid;
  const Intrinsics &from = reference.camera.intrinsics, &to = camera.intrinsics;
  const Pose between = camera.world_to_camera * reference.camera.world_to_camera.inverse();
  const double half = (grid.cell - 1) / 2.0;
  for (int y = 0; y + 1 < grid.height; ++y)
    for (int x = 0; x + 1 < grid.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * grid.width + x;
      const double z = grid.depth[i], u = x * grid.cell + half, v = y * grid.cell + half;
      if (z == 0) continue;
      const Eigen::Vector3d p =
          between * Eigen::Vector3d(z * (u - from.cx) / from.fx, z * (v - from.cy) / from.fy, z);
      if (p.z() <= 0) continue;
      const auto at = corner_of(frame, (to.fx * p.x() / p.z() + to.cx - half) / frame.cell,
                                (to.fy * p.y() / p.z() + to.cy - half) / frame.cell);
      if (!at) continue;
      const float depth = around(frame, frame.depth, *at)[(at->right > 0.5f) + 2 * (at->down > 0.5f)];
      if (!(std::abs(depth - p.z()) < kSamePlace * p.z())) continue;
      const auto near = around(frame, frame.colour, *at);
      const Eigen::Vector3f mean = (1 - at->down) * ((1 - at->right) * near[0] + at->right * near[1]) +
                                   at->down * ((1 - at->right) * near[2] + at->right * near[3]);
      const Eigen::Vector3f peak = peak_of(around(frame, frame.peak, *at));
      const Eigen::Vector3f own_peak = peak_of(around(grid, grid.peak, {x, y}));
      for (int c = 0; c < 3; ++c)
        pairs[c].push_back({grid.colour[i][c], own_peak[c], mean[c], peak[c], reference.gains[c]});
    }
}

/// Whether a cell is neither dark nor saturated, nor would be in an exposure `factor` times its own.
bool tells(float mean, float peak, float factor) {
  return mean * std::min(1.0f, factor) > kDarkCell && peak * std::max(1.0f, factor) < ColourGrid::kFull;
}

/// The logarithms of the gains that the pairs of a channel ask for, where both cells tell something.
std::vector<float> all_logs(const std::vector<CellPair>& pairs) {
  std::vector<float> logs;
  for (const CellPair& pair : pairs)
    if (tells(pair.frame, pair.frame_peak, 1) && tells(pair.reference, pair.reference_peak, 1))
      logs.push_back(std::log(pair.reference_gain * pair.reference / pair.frame));
  return logs;
}

/// Of those, the ones of pairs that would tell something in the exposures of both images, where the gain is
/// about exp(`about`): else those are left out that happen to be bright in the brighter image, and what
/// remains makes it look darker than it is.
std::vector<float> fair_logs(const std::vector<CellPair>& pairs, float about) {
  std::vector<float> logs;
  for (const CellPair& pair : pairs) {
    const float factor = std::exp(about) / pair.reference_gain;  // from the frame to the reference
    if (tells(pair.frame, pair.frame_peak, factor) && tells(pair.reference, pair.reference_peak, 1 / factor))
      logs.push_back(std::log(pair.reference_gain * pair.reference / pair.frame));
  }
  return logs;
}

float quartile(std::vector<float>& values, std::size_t number) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(number * (values.size() - 1) / 4);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The change of exposure that the pairs of a channel show.
struct Shift {
  float middle = 0;    ///< the median of the fair logarithms
  bool clear = false;  ///< three quarters of all have its sign
};

/// None where too few pairs tell.
std::optional<Shift> shift_of(const std::vector<CellPair>& pairs) {
  std::vector<float> logs = all_logs(pairs);
  if (logs.size() < kFewestRatios) return std::nullopt;
  const float low = quartile(logs, 1), high = quartile(logs, 3);
  Shift shift{.middle = quartile(logs, 2)};
  for (int round = 0; round < kRoundsOfShift; ++round) {
    std::vector<float> fair = fair_logs(pairs, shift.middle);
    if (fair.size() < kFewestRatios) break;
    shift.middle = quartile(fair, 2);
  }
  shift.clear = shift.middle * (shift.middle > 0 ? low : high) > 0;
  return shift;
}

/// Calls act(value, least, pixel, channel) for each channel that was darkened and may have been saturated.
template <typename Image, typename Act>
void visit_saturated(Image& colour, const Eigen::Vector3f& gains, Act act) {
  for (int c = 0; c < 3; ++c) {
    if (!(gains[c] < 1)) continue;
    const auto least = cv::saturate_cast<uint8_t>(gains[c] * ColourGrid::kFull);
    for (int i = 0; i < colour.rows * colour.cols; ++i) {
      auto& value = colour.template ptr<uint8_t>()[3 * i + c];
      if (value >= least) act(value, i, c);
    }
  }
}

}  // namespace

Eigen::Vector3f find_gains(const ColourGrid& frame, const Camera& camera, std::span<const LitView> references,
                           const Eigen::Vector3f& before, double least) {
  CellPairs pairs;
  for (const LitView& reference : references) compare(frame, camera, reference, pairs);
  const double limit = std::log1p(least);
  std::optional<Shift> shifts[3];
  bool beyond = false, clear = false;
  float sum = 0;
  int told = 0;
  for (int c = 0; c < 3; ++c) {
    shifts[c] = shift_of(pairs[c]);
    if (!shifts[c]) continue;
    sum += shifts[c]->middle;
    ++told;
    if (!(std::abs(shifts[c]->middle) > limit)) continue;
    beyond = true;
    clear = clear || shifts[c]->clear;
  }
  if (told == 0 || (beyond && !clear)) return before;
  if (!beyond) return Eigen::Vector3f::Ones();
  Eigen::Vector3f gains;
  for (int c = 0; c < 3; ++c)
    gains[c] = std::exp(shifts[c] ? shifts[c]->middle : sum / static_cast<float>(told));
  return gains;
}

cv::Mat apply_gains(const cv::Mat& colour, const Eigen::Vector3f& gains) {
  cv::Mat exposed(colour.size(), colour.type());
  for (int i = 0; i < colour.rows * colour.cols; ++i)
    for (int c = 0; c < 3; ++c)
      exposed.ptr<uint8_t>()[3 * i + c] =
          cv::saturate_cast<uint8_t>(gains[c] * static_cast<float>(colour.ptr<uint8_t>()[3 * i + c]));
  return exposed;
}

bool has_saturated(const cv::Mat& colour, const Eigen::Vector3f& gains) {
  bool found = false;
  visit_saturated(colour, gains, [&](uint8_t, int, int) { found = true; });
  return found;
}

void brighten_saturated(cv::Mat& colour, const RenderImages& rendered, const Eigen::Vector3f& gains) {
  visit_saturated(colour, gains, [&](uint8_t& value, int pixel, int channel) {
    if (rendered.opacity[pixel] >= kShown)
      value = std::max(value, cv::saturate_cast<uint8_t>(
                                  255 * rendered.colour[3 * static_cast<std::size_t>(pixel) + channel]));
  });
}

void scale_colours(GaussianCloud& cloud, const Eigen::Vector3f& gains) {
  if (gains == Eigen::Vector3f::Ones()) return;
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  for (std::size_t i = 0; i < cloud.sh.size(); ++i) {
    const float gain = gains[static_cast<Eigen::Index>(i % 3)];
    const float offset = i / 3 % coefficients == 0 ? 0.5f / kHarmonicBase : 0.0f;
    cloud.sh[i] = gain * (cloud.sh[i] + offset) - offset;
  }
}

void scale_colours(RenderImages& images, const Eigen::Vector3f& gains) {
  if (gains == Eigen::Vector3f::Ones()) return;
  for (std::size_t i = 0; i < images.colour.size(); ++i)
    images.colour[i] *= gains[static_cast<Eigen::Index>(i % 3)];
}

}  // namespace surefield
