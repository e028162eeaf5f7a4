#include "engine/window/panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace surefield {

namespace {

constexpr float kWidth = 350;              // pixels of usual text
constexpr std::size_t kMostPlotted = 600;  // frames

struct StyleName {
  CameraStyle style;
  const char* name;
};
constexpr std::array kStyles = {StyleName{CameraStyle::Orbit, "orbit"}, StyleName{CameraStyle::Fly, "fly"},
                                StyleName{CameraStyle::Follow, "behind it"},
                                StyleName{CameraStyle::Through, "through it"}};

void draw_modes(const PanelContent& content, ViewerState& state) {
  for (const ViewModeInfo& info : view_modes()) {
    if (info.needs_sensor && !content.has_sensor) {
      ImGui::TextDisabled("      %s (no image)", info.title);
      continue;
    }
    if (ImGui::RadioButton(info.title, state.view.mode == info.mode)) state.view.mode = info.mode;
  }
  if (state.view.mode == ViewMode::Depth || state.view.mode == ViewMode::MedianDepth)
    ImGui::SliderFloat("far, m", &state.view.depth_far, 0.2f, 20, "%.2f", ImGuiSliderFlags_Logarithmic);
  if (state.view.mode == ViewMode::Uncertainty || state.view.mode == ViewMode::GaussianUncertainty)
    ImGui::SliderFloat("pale is, m", &state.view.error_far, 0.005f, 1, "%.3f", ImGuiSliderFlags_Logarithmic);
}

void draw_camera(const PanelContent& content, ViewerState& state, ViewerRequests& requests) {
  for (std::size_t i = 0; i < kStyles.size(); ++i) {
    if (i % 2 != 0) ImGui::SameLine(0.5f * kWidth * content.scale);
    if (ImGui::RadioButton(kStyles[i].name, state.style == kStyles[i].style)) state.style = kStyles[i].style;
  }
  if (ImGui::Button("Reset")) requests.reset = true;
  ImGui::SameLine();
  if (ImGui::Button("< keyframe")) requests.keyframes = -1;
  ImGui::SameLine();
  if (ImGui::Button("keyframe >")) requests.keyframes = 1;
  ImGui::SliderInt("coarseness", &state.coarseness, 1, 4, "%d", ImGuiSliderFlags_AlwaysClamp);
}

void draw_run(const PanelContent& content, ViewerState& state, ViewerRequests& requests) {
  ImGui::TextWrapped("%s", content.status.c_str());
  ImGui::Text("%u Gaussians", content.gaussians);
  if (content.live || content.positions > 1) {
    if (ImGui::Button(state.running ? "Pause" : "Go on")) state.running = !state.running;
    ImGui::SameLine();
    if (ImGui::Button("Step")) {
      state.running = false;
      requests.step = true;
    }
  }
  if (content.live) {
    ImGui::SameLine();
    if (ImGui::Button("End the run")) requests.stop = true;
    ImGui::Checkbox("end the run with the window", &state.stop_on_close);
  } else if (content.positions > 1) {
    ImGui::SliderInt("frame", &state.position, 0, content.positions - 1, "%d", ImGuiSliderFlags_AlwaysClamp);
  }
  if (ImGui::Button("Screenshot")) requests.screenshot = true;
  ImGui::SameLine();
  if (ImGui::Button("Save map")) requests.save_map = true;
  if (!content.message.empty()) ImGui::TextWrapped("%s", content.message.c_str());
}

void draw_lines_choice(OverlayChoice& overlay) {
  ImGui::Checkbox("trajectory", &overlay.trajectory);
  ImGui::SameLine();
  ImGui::Checkbox("truth", &overlay.truth);
  ImGui::SameLine();
  ImGui::Checkbox("camera", &overlay.camera);
  ImGui::Checkbox("keyframes", &overlay.keyframes);
  ImGui::SameLine();
  ImGui::Checkbox("window and links", &overlay.window);
  ImGui::Checkbox("before the map", &overlay.on_top);
  float frustum = static_cast<float>(overlay.frustum);
  if (ImGui::SliderFloat("frusta, m", &frustum, 0.01f, 1, "%.2f", ImGuiSliderFlags_Logarithmic))
    overlay.frustum = frustum;
}

/// One quantity over the last frames, with its newest value.
void plot(const PanelContent& content, const char* title, float FrameNumbers::*quantity, const char* format) {
  const auto& all = *content.numbers;
  const std::size_t first = all.size() - std::min(all.size(), kMostPlotted);
  std::vector<float> values;
  for (std::size_t i = first; i < all.size(); ++i) values.push_back(all[i].*quantity);
  const auto known = [](float value) { return std::isfinite(value); };
  if (values.empty() || std::none_of(values.begin(), values.end(), known)) return;
  for (float& value : values) value = known(value) ? value : 0;
  const std::string text = fmt::format(fmt::runtime(format), values.back());
  ImGui::PlotLines(title, values.data(), static_cast<int>(values.size()), 0, text.c_str(), 0, FLT_MAX,
                   ImVec2(0.66f * kWidth * content.scale, 2.6f * ImGui::GetTextLineHeight()));
}

void draw_plots(const PanelContent& content) {
  plot(content, "loss", &FrameNumbers::loss, "{:.4f}");
  plot(content, "FPS", &FrameNumbers::frames_per_second, "{:.2f}");
  plot(content, "Gaussians", &FrameNumbers::gaussians, "{:.0f}");
  plot(content, "ATE, cm", &FrameNumbers::ate_cm, "{:.2f}");
}

/// A slider for one setting; wide ranges are stretched at their low end.
bool draw_setting(NumberSetting& setting) {
  const bool wide = setting.range.max > 100;
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
  ImGui::PushID(setting.key.c_str());
  ImGui::TextUnformatted(setting.key.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", setting.help.c_str());
  ImGui::SetNextItemWidth(-1);
  bool changed = false;
  if (setting.whole) {
    int value = static_cast<int>(setting.value);
    changed = ImGui::SliderInt("##value", &value, static_cast<int>(setting.range.min),
                               static_cast<int>(setting.range.max), "%d", flags);
    setting.value = value;
  } else {
    float value = static_cast<float>(setting.value);
    changed = ImGui::SliderFloat("##value", &value, static_cast<float>(setting.range.min),
                                 static_cast<float>(setting.range.max), "%.4g", flags);
    if (changed) setting.value = value;
  }
  ImGui::PopID();
  return changed;
}

void draw_keys(float scale) {
  ImGui::TextUnformatted("1 ... 9, 0, -");
  ImGui::SameLine(110 * scale);
  ImGui::TextWrapped("the modes, in their order");
  for (const KeyBinding& binding : key_bindings()) {
    ImGui::TextUnformatted(binding.name);
    ImGui::SameLine(110 * scale);
    ImGui::TextWrapped("%s", binding.what);
  }
}

}  // namespace

ViewerRequests draw_panel(const PanelContent& content, ViewerState& state,
                          std::vector<NumberSetting>& settings, std::vector<std::size_t>& changed) {
  ViewerRequests requests;
  const float margin = 8 * content.scale;
  const float height = ImGui::GetIO().DisplaySize.y - 2 * margin;
  ImGui::SetNextWindowPos(ImVec2(margin, margin), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(kWidth * content.scale, 0),
                                      ImVec2(kWidth * content.scale, height));
  ImGui::SetNextWindowBgAlpha(0.85f);
  ImGui::Begin("Surefield", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushItemWidth(0.6f * kWidth * content.scale);
  const auto section = [](const char* title, bool open) {
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  };
  if (section("Run", true)) draw_run(content, state, requests);
  if (section("Picture", true)) draw_modes(content, state);
  if (section("Camera", true)) draw_camera(content, state, requests);
  if (section("Lines", false)) draw_lines_choice(state.overlay);
  if (content.numbers && !content.numbers->empty() && section("Plots", content.live)) draw_plots(content);
  if (!settings.empty() && section("Settings", false))
    for (std::size_t i = 0; i < settings.size(); ++i)
      if (draw_setting(settings[i])) changed.push_back(i);
  if (section("Keys", false)) draw_keys(content.scale);
  ImGui::PopItemWidth();
  ImGui::End();
  return requests;
}

}  // namespace surefield
