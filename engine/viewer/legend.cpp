#include "engine/viewer/legend.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "engine/viewer/scales.h"

namespace surefield {

namespace {

constexpr int kMostTicks = 6;
constexpr double kInCentimetres = 1;  // metres; scales that end below are labelled in centimetres

/// The quantity of a mode that paints values.
const char* quantity_of(ViewMode mode) {
  switch (mode) {
    case ViewMode::Depth:
      return "depth";
    case ViewMode::MedianDepth:
      return "median depth";
    case ViewMode::Opacity:
      return "opacity";
    case ViewMode::Uncertainty:
      return "off the sensor's depth (1 sigma)";
    case ViewMode::GaussianUncertainty:
      return "uncertainty (1 sigma)";
    case ViewMode::Error:
      return "difference of the colours";
    default:
      return "";
  }
}

bool has_metres(ViewMode mode) {
  return mode != ViewMode::Opacity && mode != ViewMode::Error;
}

std::vector<uint32_t> colours_of(const cv::Mat& levels, int map) {
  cv::Mat colours;
  if (map < 0)
    cv::cvtColor(levels, colours, cv::COLOR_GRAY2BGR);
  else
    cv::applyColorMap(levels, colours, map);
  cv::cvtColor(colours, colours, cv::COLOR_BGR2RGBA);
  const auto* begin = colours.ptr<uint32_t>();
  return {begin, begin + kPaletteSize};
}

}  // namespace

std::vector<uint32_t> palette_of(ViewMode mode) {
  cv::Mat levels(1, kPaletteSize, CV_8UC1);
  for (int i = 0; i < levels.cols; ++i) levels.at<uint8_t>(i) = static_cast<uint8_t>(i);
  switch (mode) {
    case ViewMode::Depth:
    case ViewMode::MedianDepth:
      return colours_of(levels, cv::COLORMAP_TURBO);
    case ViewMode::Opacity:
      return colours_of(levels, -1);
    case ViewMode::Uncertainty:
    case ViewMode::GaussianUncertainty:
    case ViewMode::Error:
      return colours_of(levels, cv::COLORMAP_INFERNO);
    default:
      return {};
  }
}

std::pair<float, float> scale_of(const ViewSettings& settings) {
  switch (settings.mode) {
    case ViewMode::Depth:
    case ViewMode::MedianDepth:
      return {settings.depth_near, settings.depth_far};
    case ViewMode::Opacity:
      return {0.0f, 1.0f};
    case ViewMode::Error:
      return {0.0f, glsl::FULL_ERROR};
    default:
      return {0.0f, settings.error_far};
  }
}

std::optional<Legend> legend_of(const ViewSettings& settings) {
  Legend legend{.palette = palette_of(settings.mode)};
  if (legend.palette.empty()) return std::nullopt;
  const auto [low, high] = scale_of(settings);
  const bool metres = has_metres(settings.mode);
  const bool small = metres && high < kInCentimetres;
  const double unit = small ? 100 : 1;
  legend.title = fmt::format("{}{}", quantity_of(settings.mode), !metres ? "" : small ? ", cm" : ", m");
  legend.low = unit * low;
  legend.high = unit * high;
  legend.ticks = ticks_between(legend.low, legend.high, kMostTicks);
  for (double tick : legend.ticks) legend.text.push_back(fmt::format("{:g}", std::round(1e6 * tick) / 1e6));
  return legend;
}

}  // namespace surefield
