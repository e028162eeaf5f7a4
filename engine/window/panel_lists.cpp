#include "engine/window/panel_lists.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "engine/viewer/scales.h"

namespace surefield {

namespace {

constexpr std::size_t kMostPlotted = 600;  // frames
constexpr float kListedKeyframes = 7;      // lines of their list

/// One quantity over the last frames, with its newest value, `beside` the one before; false where none is
/// known.
bool plot(const PanelContent& content, float FrameNumbers::*quantity, const char* format, bool beside) {
  const auto& all = *content.numbers;
  const std::size_t first = all.size() - std::min(all.size(), kMostPlotted);
  std::vector<float> values;
  for (std::size_t i = first; i < all.size(); ++i) values.push_back(all[i].*quantity);
  const auto known = [](float value) { return std::isfinite(value); };
  if (values.empty() || std::none_of(values.begin(), values.end(), known)) return false;
  for (float& value : values) value = known(value) ? value : 0;
  const std::string text = fmt::format(fmt::runtime(format), values.back());
  if (beside) ImGui::SameLine();
  ImGui::PushID(format);
  ImGui::PlotLines("##plot", values.data(), static_cast<int>(values.size()), 0, text.c_str(), 0, FLT_MAX,
                   ImVec2(0.46f * kPanelWidth * content.scale, 2.4f * ImGui::GetTextLineHeight()));
  ImGui::PopID();
  return true;
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

}  // namespace

void draw_plots(const PanelContent& content) {
  int drawn = 0;
  const auto next = [&](float FrameNumbers::*quantity, const char* format) {
    if (plot(content, quantity, format, drawn % 2 != 0)) ++drawn;
  };
  next(&FrameNumbers::loss, "loss {:.4f}");
  next(&FrameNumbers::frames_per_second, "{:.2f} frames/s");
  next(&FrameNumbers::gaussians, "{:.0f} Gaussians");
  next(&FrameNumbers::ate_cm, "ATE {:.2f} cm");
}

void draw_keyframes(const PanelContent& content, ViewerRequests& requests) {
  const Trajectory& keyframes = *content.keyframes;
  const double first = content.trajectory->empty() ? 0 : content.trajectory->front().timestamp;
  ImGui::BeginChild("keyframes", ImVec2(0, kListedKeyframes * ImGui::GetTextLineHeightWithSpacing()), true);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(keyframes.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const double seconds = keyframes[static_cast<std::size_t>(i)].timestamp - first;
      const std::string text = fmt::format("{:<6} {}", i, format_time(seconds));
      if (ImGui::Selectable(text.c_str(), i == content.keyframe)) requests.keyframe = i;
    }
  ImGui::EndChild();
}

void draw_settings(std::vector<NumberSetting>& settings, std::vector<std::size_t>& changed) {
  for (std::size_t i = 0; i < settings.size(); ++i)
    if (draw_setting(settings[i])) changed.push_back(i);
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

}  // namespace surefield
