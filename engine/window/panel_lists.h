#pragma once

#include "engine/window/panel.h"

namespace surefield {

inline constexpr float kPanelWidth = 350;  ///< pixels of usual text

// The sections of the panel that grow with a run; each draws what stands under its header.

/// Loss, frames a second, Gaussians and ATE over the last frames.
void draw_plots(const PanelContent& content);
/// The keyframes with their times; a click on one goes there.
void draw_keyframes(const PanelContent& content, ViewerRequests& requests);
/// Sliders for the settings of a run; adds to `changed` those that the user has moved.
void draw_settings(std::vector<NumberSetting>& settings, std::vector<std::size_t>& changed);
/// The keys and what they do.
void draw_keys(float scale);

}  // namespace surefield
