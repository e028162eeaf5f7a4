#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>

namespace surefield {

/// Text that can stand anywhere in HTML, attributes included. Bytes that are no UTF-8 become question marks,
/// so that the page stays readable whatever a file was called.
std::string escape_html(std::string_view text);

/// Bytes in base64, as data: addresses and pages hold them.
std::string base64(std::string_view bytes);

/// The image (CV_8UC3, RGB) as an <img> element that carries its own pixels (JPEG); wider ones are shrunk to
/// `widest` pixels. `description` is for those who cannot see it.
std::string html_image(const cv::Mat& image, const std::string& description, int widest);

}  // namespace surefield
