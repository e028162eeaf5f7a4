#include "engine/viewer/film_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace surefield {

namespace {

constexpr double kMargin = 0.015;     // of the picture's height, round insets
constexpr double kTextHeight = 0.03;  // of the picture's height
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontHeight = 21;   // pixels of a capital letter at scale 1
constexpr double kSmallestText = 9;  // pixels
const cv::Scalar kInk(235, 235, 235);

/// Writes on a darkened ground whose upper left corner is `at`.
void write_text(cv::Mat& picture, const std::string& text, const cv::Point& at) {
  const double height = std::max(kTextHeight * picture.rows * 0.7, kSmallestText);
  const double scale = height / kFontHeight;
  const int thickness = std::max(1, static_cast<int>(std::lround(height / 12)));
  int below = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale, thickness, &below);
  const int pad = below;
  const cv::Rect ground = cv::Rect(at, cv::Size(size.width + 2 * pad, size.height + below + 2 * pad)) &
                          cv::Rect({}, picture.size());
  picture(ground) *= 0.35;
  cv::putText(picture, text, at + cv::Point(pad, pad + size.height), kFont, scale, kInk, thickness,
              cv::LINE_AA);
}

int margin_of(const cv::Mat& picture) {
  return std::max(2, static_cast<int>(std::lround(kMargin * picture.rows)));
}

}  // namespace

void add_inset(cv::Mat& picture, const cv::Mat& image, Corner corner, const std::string& name) {
  const double scale = kInsetShare * std::min(static_cast<double>(picture.cols) / image.cols,
                                              static_cast<double>(picture.rows) / image.rows);
  const cv::Size size(std::max(1, static_cast<int>(scale * image.cols)),
                      std::max(1, static_cast<int>(scale * image.rows)));
  const int margin = margin_of(picture);
  const int x = corner == Corner::BottomLeft ? margin : picture.cols - margin - size.width;
  const cv::Rect place =
      cv::Rect({x, picture.rows - margin - size.height}, size) & cv::Rect({}, picture.size());
  if (place.size() != size) return;  // the picture has no room
  cv::Mat part = picture(place);
  cv::resize(image, part, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  write_text(part, name, {});
  cv::rectangle(picture, place, kInk, 1);
}

void add_caption(cv::Mat& picture, const std::string& text) {
  write_text(picture, text, {margin_of(picture), margin_of(picture)});
}

}  // namespace surefield
