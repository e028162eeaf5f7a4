#include "engine/window/picture_labels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/viewer/axes_gizmo.h"
#include "engine/viewer/scales.h"

namespace surefield {

namespace {

// Pixels of usual text.
constexpr float kMargin = 14;
constexpr float kBarWidth = 16;
constexpr float kArm = 34;           // of the axes
constexpr float kLongestBar = 180;   // of the scale
constexpr float kLeastHeight = 300;  // windows that are lower have no room for scales
constexpr ImU32 kInk = IM_COL32(240, 240, 240, 255);
constexpr ImU32 kGround = IM_COL32(16, 16, 18, 190);

ImU32 colour_of(const Eigen::Vector3f& colour) {
  const auto level = [](float value) { return static_cast<int>(255 * value); };
  return IM_COL32(level(colour.x()), level(colour.y()), level(colour.z()), 255);
}

/// Draws with one scale, for a window of one size.
class Labeller {
 public:
  explicit Labeller(const PictureLabels& labels)
      : labels_(labels),
        list_(*ImGui::GetBackgroundDrawList()),
        window_(ImGui::GetIO().DisplaySize),
        line_(ImGui::GetTextLineHeightWithSpacing()) {}

  float scaled(float size) const { return size * labels_.scale; }
  bool has_room() const { return window_.y >= scaled(kLeastHeight); }

  /// Text on a ground on which it can be read, with its upper left corner there.
  void write(const ImVec2& at, const std::vector<std::string>& lines) const {
    const ImVec2 size = size_of(lines);
    const float pad = scaled(5);
    list_.AddRectFilled(ImVec2(at.x - pad, at.y - pad), ImVec2(at.x + size.x + pad, at.y + size.y + pad),
                        kGround, scaled(4));
    for (std::size_t i = 0; i < lines.size(); ++i)
      list_.AddText(ImVec2(at.x, at.y + line_ * static_cast<float>(i)), kInk, lines[i].c_str());
  }

  /// The same beside a place, where the window has room.
  void write_beside(const PlacedText& text) const {
    const ImVec2 size = size_of(text.lines);
    const float gap = scaled(16);
    ImVec2 at(static_cast<float>(text.place.x()) + gap, static_cast<float>(text.place.y()) + gap);
    if (at.x + size.x + gap > window_.x) at.x -= size.x + 2 * gap;
    if (at.y + size.y + gap > window_.y) at.y -= size.y + 2 * gap;
    write(at, text.lines);
  }

  void write_in_middle(const std::string& text) const {
    const ImVec2 size = size_of({text});
    write(ImVec2((window_.x - size.x) / 2, (window_.y - size.y) / 2), {text});
  }

  /// The colours from low (below) to high at the right, with their values.
  void draw_legend(const Legend& legend) const {
    const float height = std::min(0.4f * window_.y, scaled(280)), margin = scaled(kMargin);
    const ImVec2 title = ImGui::CalcTextSize(legend.title.c_str());
    float widest = title.x - scaled(kBarWidth);
    for (const std::string& text : legend.text)
      widest = std::max(widest, ImGui::CalcTextSize(text.c_str()).x + scaled(10));
    const float left = window_.x - margin - scaled(kBarWidth) - widest, top = margin + 1.6f * line_;
    const float right = left + scaled(kBarWidth), bottom = top + height, pad = scaled(7);
    list_.AddRectFilled(ImVec2(left - pad, margin - pad), ImVec2(window_.x - margin + pad, bottom + line_),
                        kGround, scaled(4));
    list_.AddText(ImVec2(left, margin), kInk, legend.title.c_str());
    const auto levels = static_cast<float>(legend.palette.size());
    for (std::size_t i = 0; i < legend.palette.size(); ++i) {
      const float low = bottom - height * static_cast<float>(i) / levels;
      list_.AddRectFilled(ImVec2(left, low - height / levels), ImVec2(right, low), legend.palette[i]);
    }
    for (std::size_t i = 0; i < legend.ticks.size(); ++i) {
      const double share = (legend.ticks[i] - legend.low) / (legend.high - legend.low);
      const float y = bottom - height * static_cast<float>(share);
      list_.AddLine(ImVec2(right - scaled(4), y), ImVec2(right + scaled(4), y), kInk, scaled(1));
      list_.AddText(ImVec2(right + scaled(8), y - title.y / 2), kInk, legend.text[i].c_str());
    }
  }

  /// The world's axes in the lower right corner.
  void draw_axes() const {
    const float arm = scaled(kArm), reach = arm + scaled(16);
    const ImVec2 middle(window_.x - scaled(kMargin) - reach, window_.y - scaled(kMargin) - reach);
    list_.AddCircleFilled(middle, reach, kGround, 48);
    for (const AxisArm& seen : axes_seen(labels_.camera_to_world, labels_.up)) {
      const ImVec2 tip(middle.x + arm * static_cast<float>(seen.tip.x()),
                       middle.y + arm * static_cast<float>(seen.tip.y()));
      list_.AddLine(middle, tip, colour_of(seen.colour), scaled(2.5f));
      const ImVec2 size = ImGui::CalcTextSize(seen.name);
      const float past = scaled(8);
      list_.AddText(ImVec2(tip.x + past * static_cast<float>(seen.tip.x()) - size.x / 2,
                           tip.y + past * static_cast<float>(seen.tip.y()) - size.y / 2),
                    colour_of(seen.colour), seen.name);
    }
  }

  /// A round length at the distance of what is looked at, to the left of the axes.
  void draw_scale_bar() const {
    const double length = round_below(scaled(kLongestBar) * labels_.metres_a_pixel);
    const auto pixels = static_cast<float>(length / labels_.metres_a_pixel);
    const std::string text =
        fmt::format("{} at {}", format_round_length(length), format_length(labels_.distance));
    const float width = std::max(pixels, ImGui::CalcTextSize(text.c_str()).x), pad = scaled(6);
    const ImVec2 end(window_.x - 3 * scaled(kMargin) - 2 * scaled(kArm + 16),
                     window_.y - scaled(kMargin) - pad);
    list_.AddRectFilled(ImVec2(end.x - width - pad, end.y - line_ - scaled(10) - pad),
                        ImVec2(end.x + pad, end.y + pad), kGround, scaled(4));
    list_.AddText(ImVec2(end.x - width, end.y - line_ - scaled(10)), kInk, text.c_str());
    const ImVec2 begin(end.x - pixels, end.y);
    list_.AddLine(begin, end, kInk, scaled(2));
    for (const ImVec2& tip : {begin, end})
      list_.AddLine(ImVec2(tip.x, tip.y - scaled(8)), tip, kInk, scaled(2));
  }

 private:
  ImVec2 size_of(const std::vector<std::string>& lines) const {
    float width = 0;
    for (const std::string& line : lines) width = std::max(width, ImGui::CalcTextSize(line.c_str()).x);
    return ImVec2(width, line_ * static_cast<float>(lines.size()));
  }

  const PictureLabels& labels_;
  ImDrawList& list_;
  const ImVec2 window_;
  const float line_;
};

}  // namespace

void draw_labels(const PictureLabels& labels) {
  const Labeller labeller(labels);
  if (labels.scales && labeller.has_room()) {
    if (labels.legend) labeller.draw_legend(*labels.legend);
    labeller.draw_axes();
    if (labels.metres_a_pixel > 0) labeller.draw_scale_bar();
  }
  if (labels.ruler) labeller.write_beside(*labels.ruler);
  if (labels.hint) labeller.write_beside(*labels.hint);
  if (!labels.waiting.empty()) labeller.write_in_middle(labels.waiting);
}

}  // namespace surefield
