#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/types/camera.h"
#include "engine/viewer/legend.h"

namespace surefield {

/// A line or more of text at a place of the window.
struct PlacedText {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< pixels of the window
  std::vector<std::string> lines;
};

/// What is written and drawn over the picture, beside the panel.
struct PictureLabels {
  bool scales = true;                              ///< legend, axes and scale bar
  std::optional<Legend> legend;                    ///< of the colours
  Pose camera_to_world = Pose::Identity();         ///< of the picture
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();  ///< in the world, unit length
  double distance = 1;                             ///< of what is looked at, metres
  double metres_a_pixel = 0;                       ///< of the window, at that distance
  std::optional<PlacedText> hint;                  ///< beside the mouse
  std::optional<PlacedText> ruler;                 ///< beside its middle
  std::string waiting;  ///< in the middle of the picture, where there is no map yet
  float scale = 1;      ///< of text
};

/// Draws them, behind the panel.
void draw_labels(const PictureLabels& labels);

}  // namespace surefield
