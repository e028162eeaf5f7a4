#include "engine/window/panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>

#include "engine/viewer/scales.h"
#include "engine/viewer/timeline.h"
#include "engine/window/panel_lists.h"

namespace surefield {

namespace {

struct StyleName {
  CameraStyle style;
  const char* name;
};
constexpr std::array kStyles = {StyleName{CameraStyle::Orbit, "orbit"}, StyleName{CameraStyle::Fly, "fly"},
                                StyleName{CameraStyle::Follow, "behind the camera"},
                                StyleName{CameraStyle::Through, "through its eyes"}};

constexpr std::array<const char*, kCoarsest> kResolutions = {"full", "half", "a third", "a quarter"};

bool has_depth_scale(ViewMode mode) {
  return mode == ViewMode::Depth || mode == ViewMode::MedianDepth;
}

bool has_error_scale(ViewMode mode) {
  return mode == ViewMode::Uncertainty || mode == ViewMode::GaussianUncertainty;
}

/// The mode with its key, or why it cannot be had.
std::string entry_of(const ViewModeInfo& info, bool possible) {
  return fmt::format("{}  {}{}", key_of(info.mode), info.title, possible ? "" : " (no image)");
}

void draw_modes(const PanelContent& content, ViewerState& state) {
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##mode", info_of(state.view.mode).title, ImGuiComboFlags_HeightLargest)) {
    for (const ViewModeInfo& info : view_modes()) {
      const bool possible = !info.needs_sensor || content.has_sensor;
      const auto flags = possible ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled;
      if (ImGui::Selectable(entry_of(info, possible).c_str(), state.view.mode == info.mode, flags))
        state.view.mode = info.mode;
    }
    ImGui::EndCombo();
  }
  if (has_depth_scale(state.view.mode))
    ImGui::SliderFloat("scale, m", &state.view.depth_far, 0.2f, 20, "0 to %.2f",
                       ImGuiSliderFlags_Logarithmic);
  if (has_error_scale(state.view.mode))
    ImGui::SliderFloat("scale, m", &state.view.error_far, 0.005f, 1, "0 to %.3f",
                       ImGuiSliderFlags_Logarithmic);
}

void draw_picture(const PanelContent& content, ViewerState& state) {
  draw_modes(content, state);
  int backdrop = static_cast<int>(state.backdrop);
  const auto name_of = [](void*, int i, const char** name) {
    *name = backdrops()[static_cast<std::size_t>(i)].name;
    return true;
  };
  if (ImGui::Combo("background", &backdrop, name_of, nullptr, static_cast<int>(backdrops().size()))) {
    state.backdrop = backdrops()[static_cast<std::size_t>(backdrop)].backdrop;
    set_backdrop(state.view, state.backdrop);
  }
  int resolution = state.coarseness - 1;
  if (ImGui::Combo("resolution", &resolution, kResolutions.data(), kCoarsest))
    state.coarseness = resolution + 1;
  ImGui::Checkbox("colour bar, axes and scale bar", &state.scales);
}

void draw_camera(const PanelContent& content, ViewerState& state, ViewerRequests& requests) {
  for (std::size_t i = 0; i < kStyles.size(); ++i) {
    if (i % 2 != 0) ImGui::SameLine(0.5f * kPanelWidth * content.scale);
    if (ImGui::RadioButton(kStyles[i].name, state.style == kStyles[i].style)) state.style = kStyles[i].style;
  }
  if (ImGui::Button("Start of the view")) requests.reset = true;
  ImGui::SameLine();
  if (ImGui::Button("< keyframe")) requests.keyframes = -1;
  ImGui::SameLine();
  if (ImGui::Button("keyframe >")) requests.keyframes = 1;
}

/// A recorded trajectory in seconds, to be moved along.
void draw_timeline(const PanelContent& content, ViewerState& state) {
  const Timeline timeline(*content.trajectory);
  auto seconds = static_cast<float>(timeline.seconds_at(state.position));
  const std::string text = fmt::format("{} of {}, frame {}", format_time(timeline.seconds_at(state.position)),
                                       format_time(timeline.duration()), state.position);
  ImGui::SetNextItemWidth(-1);
  const auto end = static_cast<float>(timeline.duration());
  if (ImGui::SliderFloat("##time", &seconds, 0, end, text.c_str(), ImGuiSliderFlags_AlwaysClamp))
    state.position = timeline.position_at(seconds);
}

void draw_run(const PanelContent& content, ViewerState& state, ViewerRequests& requests) {
  ImGui::TextWrapped("%s, %u Gaussians", content.status.c_str(), content.gaussians);
  const bool recorded = !content.live && content.trajectory->size() > 1;
  if (content.live || recorded) {
    if (ImGui::Button(state.running ? "Pause" : "Play")) state.running = !state.running;
    ImGui::SameLine();
    if (ImGui::Button("One frame")) {
      state.running = false;
      requests.step = true;
    }
  }
  if (content.live) {
    ImGui::SameLine();
    if (ImGui::Button("End the run")) requests.stop = true;
    ImGui::Checkbox("end the run with the window", &state.stop_on_close);
  }
  if (recorded) draw_timeline(content, state);
  if (ImGui::Button("Screenshot")) requests.screenshot = true;
  ImGui::SameLine();
  if (ImGui::Button("Save map")) requests.save_map = true;
  if (!content.message.empty()) ImGui::TextWrapped("%s", content.message.c_str());
}

void draw_measuring(const PanelContent& content, ViewerState& state, ViewerRequests& requests) {
  ImGui::Checkbox("tell what is under the mouse", &state.probe);
  if (ImGui::Checkbox("ruler: click two places", &state.ruler)) requests.clear = true;
  const bool nothing = content.picked.empty() && content.distance.empty();
  if (!nothing) {
    ImGui::SameLine(0.75f * kPanelWidth * content.scale);
    if (ImGui::Button("Forget")) requests.clear = true;
  }
  for (const std::string& line : content.picked) ImGui::TextUnformatted(line.c_str());
  if (!content.distance.empty()) ImGui::TextUnformatted(content.distance.c_str());
  if (nothing)
    ImGui::TextDisabled("%s", state.ruler ? "click two places of the map" : "click on the map to know more");
}

void draw_lines_choice(OverlayChoice& overlay) {
  ImGui::Checkbox("trajectory", &overlay.trajectory);
  ImGui::SameLine();
  ImGui::Checkbox("truth", &overlay.truth);
  ImGui::SameLine();
  ImGui::Checkbox("camera", &overlay.camera);
  ImGui::Checkbox("keyframes", &overlay.keyframes);
  ImGui::SameLine();
  ImGui::Checkbox("window", &overlay.window);
  ImGui::SameLine();
  ImGui::Checkbox("loops", &overlay.loops);
  ImGui::Checkbox("also where the map hides them", &overlay.on_top);
  float frustum = static_cast<float>(overlay.frustum);
  if (ImGui::SliderFloat("cameras, m", &frustum, 0.01f, 1, "%.2f long", ImGuiSliderFlags_Logarithmic))
    overlay.frustum = frustum;
}

}  // namespace

ViewerRequests draw_panel(const PanelContent& content, ViewerState& state,
                          std::vector<NumberSetting>& settings, std::vector<std::size_t>& changed) {
  ViewerRequests requests;
  const float margin = 8 * content.scale, width = kPanelWidth * content.scale;
  const float height = ImGui::GetIO().DisplaySize.y - 2 * margin;
  ImGui::SetNextWindowPos(ImVec2(margin, margin), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, height));
  ImGui::SetNextWindowBgAlpha(0.85f);
  ImGui::Begin("Surefield", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushItemWidth(0.6f * width);
  const auto section = [](const char* title, bool open) {
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  };
  if (section("Run", true)) draw_run(content, state, requests);
  if (section("Picture", true)) draw_picture(content, state);
  if (section("Camera", true)) draw_camera(content, state, requests);
  if (section("Measure", true)) draw_measuring(content, state, requests);
  if (section("Lines", false)) draw_lines_choice(state.overlay);
  if (!content.keyframes->empty() && section("Keyframes", false)) draw_keyframes(content, requests);
  if (content.numbers && !content.numbers->empty() && section("Plots", content.live)) draw_plots(content);
  if (!settings.empty() && section("Settings", false)) draw_settings(settings, changed);
  if (section("Keys", false)) draw_keys(content.scale);
  ImGui::PopItemWidth();
  ImGui::End();
  return requests;
}

}  // namespace surefield
