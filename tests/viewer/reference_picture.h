#pragma once

#include "engine/viewer/view_painter.h"
#include "tests/reference/scenes.h"

namespace surefield::reference {

/// A picture as the definitions of its mode give it, slowly and in double precision.
struct Picture {
  /// RGB in [0, 255] of every pixel, in up to three versions where a value lies near the border of two
  /// colours of the palette.
  std::vector<std::vector<Eigen::Vector3d>> pixels;
  std::vector<uint8_t> edge;  ///< pixels in which float and double arithmetic may decide differently
};

/// What ViewPainter should paint of a scene; `sensor` is CV_8UC3.
Picture paint(const Scene& scene, const ViewSettings& settings, const cv::Mat& sensor);

}  // namespace surefield::reference
