#include "engine/slam/birth_cells.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace surefield {

namespace {

constexpr int kEven = 12;        // of 255, by which the colours of a cell differ at most in a channel
constexpr float kBend = 0.01f;   // of the depth, by which the corners of a cell leave a plane at most
constexpr float kSlope = 0.05f;  // of the depth, by which it differs at most from pixel to pixel

bool has_even_colour(const cv::Mat& colour, const BirthCell& cell) {
  cv::Vec3i low(255, 255, 255), high(0, 0, 0);
  for (int v = cell.v; v < cell.v + cell.size; ++v)
    for (int u = cell.u; u < cell.u + cell.size; ++u)
      for (int c = 0; c < 3; ++c) {
        const int value = colour.at<cv::Vec3b>(v, u)[c];
        low[c] = std::min(low[c], value);
        high[c] = std::max(high[c], value);
      }
  const cv::Vec3i range = high - low;
  return std::max({range[0], range[1], range[2]}) <= kEven;
}

/// Whether its corners lie on one surface, and on a plane.
bool is_flat(const cv::Mat& depth, const BirthCell& cell) {
  const int right = cell.u + cell.size - 1, bottom = cell.v + cell.size - 1;
  const float a = depth.at<float>(cell.v, cell.u), b = depth.at<float>(cell.v, right);
  const float c = depth.at<float>(bottom, cell.u), d = depth.at<float>(bottom, right);
  const auto [nearest, farthest] = std::minmax({a, b, c, d});
  if (!(farthest < (1 + kSlope * static_cast<float>(cell.size)) * nearest)) return false;
  return std::abs(a + d - b - c) < kBend * nearest;
}

/// The flags of a frame's pixels.
class PixelFlags {
 public:
  PixelFlags(std::vector<uint8_t> flags, const cv::Size& size) : flags_(std::move(flags)), size_(size) {}

  /// Whether the cell lies in the image and all of its pixels are flagged.
  bool all(const BirthCell& cell) const {
    if (cell.u + cell.size > size_.width || cell.v + cell.size > size_.height) return false;
    for (int v = cell.v; v < cell.v + cell.size; ++v)
      for (int u = cell.u; u < cell.u + cell.size; ++u)
        if (flags_[at(u, v)] == 0) return false;
    return true;
  }
  void clear(const BirthCell& cell) {
    for (int v = cell.v; v < cell.v + cell.size; ++v)
      for (int u = cell.u; u < cell.u + cell.size; ++u) flags_[at(u, v)] = 0;
  }

 private:
  std::size_t at(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(size_.width) + static_cast<std::size_t>(u);
  }

  std::vector<uint8_t> flags_;
  cv::Size size_;
};

}  // namespace

std::vector<BirthCell> birth_cells(const Frame& frame, std::vector<uint8_t> wanted, int largest) {
  PixelFlags left(std::move(wanted), frame.depth.size());
  std::vector<BirthCell> cells;
  for (int size = largest; size >= 1; size /= 2)
    for (int v = 0; v < frame.depth.rows; v += size)
      for (int u = 0; u < frame.depth.cols; u += size) {
        const BirthCell cell{u, v, size};
        if (!left.all(cell)) continue;
        if (size > 1 && !(has_even_colour(frame.colour, cell) && is_flat(frame.depth, cell))) continue;
        cells.push_back(cell);
        left.clear(cell);
      }
  return cells;
}

}  // namespace surefield
