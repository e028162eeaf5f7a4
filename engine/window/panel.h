#pragma once

#include "engine/config/config.h"
#include "engine/window/viewer_state.h"

namespace surefield {

/// What the panel shows beside what the user has chosen.
struct PanelContent {
  std::string status;   ///< one line: what the run does
  std::string message;  ///< one line: what was done last
  uint32_t gaussians = 0;
  bool live = false;                       ///< a run that goes on
  bool has_sensor = false;                 ///< there are images of the frame shown
  const Trajectory* trajectory = nullptr;  ///< of the frames so far, or of all that were recorded
  const Trajectory* keyframes = nullptr;
  int keyframe = -1;                ///< the one whose frame was shown last; -1: none yet
  std::vector<std::string> picked;  ///< what is known of the place that was clicked last
  std::string distance;             ///< that was measured
  float scale = 1;                  ///< of text
  const std::vector<FrameNumbers>* numbers = nullptr;
};

/// Draws the panel. Changes `state` and `settings`; returns what else the user asks for, and adds to
/// `changed` the places of the settings that were changed.
ViewerRequests draw_panel(const PanelContent& content, ViewerState& state,
                          std::vector<NumberSetting>& settings, std::vector<std::size_t>& changed);

}  // namespace surefield
