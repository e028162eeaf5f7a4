#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace surefield {

/// The most of either side of a picture that an inset takes.
inline constexpr double kInsetShare = 0.3;

/// Which corner of a picture an inset takes.
enum class Corner { BottomLeft, BottomRight };

/// Puts a small copy of `image` with its name into a corner of a picture; both CV_8UC3. It takes at most
/// three tenths of either side.
void add_inset(cv::Mat& picture, const cv::Mat& image, Corner corner, const std::string& name);

/// Writes a line at the top left of a picture (CV_8UC3), on a ground on which it can be read. ASCII only.
void add_caption(cv::Mat& picture, const std::string& text);

}  // namespace surefield
