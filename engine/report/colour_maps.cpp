#include "engine/report/colour_maps.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "engine/report/html.h"

namespace surefield {

namespace {

constexpr double kInvalidGrey = 128;

}  // namespace

cv::Mat apply_colours(const cv::Mat& values, const cv::Mat& valid, const ColourScale& scale) {
  cv::Mat levels, colours;
  values.convertTo(levels, CV_8U, 255 / (scale.high - scale.low),
                   -255 * scale.low / (scale.high - scale.low));
  cv::applyColorMap(levels, colours,
                    scale.map == ColourMap::Depth ? cv::COLORMAP_VIRIDIS : cv::COLORMAP_INFERNO);
  cv::cvtColor(colours, colours, cv::COLOR_BGR2RGB);
  colours.setTo(cv::Scalar::all(kInvalidGrey), valid == 0);
  return colours;
}

std::string colour_legend(const ColourScale& scale, const std::string& title) {
  cv::Mat ramp(1, 128, CV_32FC1);
  for (int i = 0; i < ramp.cols; ++i)
    ramp.at<float>(0, i) = static_cast<float>(i) / static_cast<float>(ramp.cols - 1);
  const cv::Mat all(ramp.size(), CV_8UC1, cv::Scalar(1));
  const cv::Mat colours = apply_colours(ramp, all, {scale.map, 0, 1, ""});
  cv::Mat bar;
  cv::resize(colours, bar, cv::Size(ramp.cols, 8), 0, 0, cv::INTER_NEAREST);
  return fmt::format("<span class=\"scale\">{} {:.3g} {} {:.3g} {}</span>", escape_html(title), scale.low,
                     html_image(bar, "from low to high", ramp.cols), scale.high, escape_html(scale.unit));
}

}  // namespace surefield
