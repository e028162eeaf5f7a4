#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string_view>

namespace surefield {

/// The size of an image packed by RVL, which its first eight bytes say; empty where they say none that there
/// can be.
cv::Size rvl_size(std::string_view packed);

/// Unpacks a depth image of RVL ("Fast Lossless Depth Image Compression", Wilson 2017): columns, rows (32
/// bits each), then words of eight 4-bit groups, in which numbers take 3 bits a group and a bit that says
/// whether more follow: in turn how many zeros, how many others, and of those the differences from one to the
/// next. CV_16UC1. Throws InputError, naming `name`, where it is damaged or has not the size `expected`.
cv::Mat decode_rvl(std::string_view packed, const std::filesystem::path& name, cv::Size expected = {});

}  // namespace surefield
