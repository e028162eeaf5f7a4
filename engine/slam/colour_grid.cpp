#include "engine/slam/colour_grid.h"

#include <algorithm>

namespace surefield {

namespace {

constexpr int kCellsAcross = 40;

/// Adds the mean and the peak of the cell at this place in the grid.
void add_colour(ColourGrid& grid, const cv::Mat& colour, int x, int y) {
  Eigen::Vector3i sum = Eigen::Vector3i::Zero(), most = Eigen::Vector3i::Zero();
  for (int v = y * grid.cell; v < (y + 1) * grid.cell; ++v) {
    const auto* row = colour.ptr<uint8_t>(v) + 3 * static_cast<std::ptrdiff_t>(x) * grid.cell;
    for (int u = 0; u < grid.cell; ++u, row += 3) {
      const Eigen::Vector3i rgb(row[0], row[1], row[2]);
      sum += rgb;
      most = most.cwiseMax(rgb);
    }
  }
  grid.colour.push_back(sum.cast<float>() / static_cast<float>(grid.cell * grid.cell));
  grid.peak.push_back(most.cast<float>());
}

}  // namespace

ColourGrid make_colour_grid(const Frame& frame) {
  ColourGrid grid;
  grid.cell = std::max(1, frame.colour.cols / kCellsAcross);
  grid.width = frame.colour.cols / grid.cell;
  grid.height = frame.colour.rows / grid.cell;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      add_colour(grid, frame.colour, x, y);
      const float z = frame.depth.at<float>(y * grid.cell + grid.cell / 2, x * grid.cell + grid.cell / 2);
      grid.depth.push_back(z > 0 ? z : 0.0f);
    }
  return grid;
}

}  // namespace surefield
