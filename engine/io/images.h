#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "engine/types/camera.h"

namespace surefield {

/// Pixels; a width or height above is a typing error or a damaged file.
inline constexpr int kLargestSide = 65536;

/// Depth units, metres for one step of a depth image.
inline constexpr double kMillimetre = 0.001;
inline constexpr double kTumDepthUnit = 1.0 / 5000;

/// How the numbers of a stored depth image are to be read.
struct DepthEncoding {
  double unit = kMillimetre;  ///< metres for one step
  int invalid_value = 0;      ///< a stored value that means "no measurement", besides 0
};

/// Reads an 8-bit colour image as CV_8UC3, RGB. Throws InputError when the file is missing or damaged,
/// truncated JPEG files included. `expected`, where it is given, is the size that it must have; of another
/// one nothing is decoded.
cv::Mat read_colour(const std::filesystem::path& file, cv::Size expected = {});

/// The same from the `bytes` of an image file; `name` is what errors call it.
cv::Mat decode_colour(const std::string& bytes, const std::filesystem::path& name, cv::Size expected = {});

/// Throws InputError, naming `file`, where an image has not the size of the calibration.
void require_size(const std::filesystem::path& file, cv::Size size, cv::Size expected);

/// The numbers of a stored depth image, CV_16UC1, as CV_32FC1, metres, 0 where invalid.
cv::Mat depth_in_metres(const cv::Mat& stored, const DepthEncoding& encoding);

/// Reads a 16-bit depth PNG as CV_32FC1, metres, 0 where invalid. Throws InputError when the file is missing,
/// damaged or not 16-bit with one channel. `expected` as for colour.
cv::Mat read_depth(const std::filesystem::path& file, const DepthEncoding& encoding, cv::Size expected = {});

/// The same from the `bytes` of an image file; `name` is what errors call it.
cv::Mat decode_depth(const std::string& bytes, const std::filesystem::path& name,
                     const DepthEncoding& encoding, cv::Size expected = {});

/// Writes a CV_32FC1 or CV_32FC3 (RGB) image as an uncompressed 32-bit float TIFF; every bit survives, NaN
/// included. Throws InputError when the type is another or the file cannot be written.
void write_tiff(const std::filesystem::path& file, const cv::Mat& image);

/// Reads what write_tiff wrote (32-bit float, 1 or 3 channels, RGB). Throws InputError otherwise.
cv::Mat read_tiff(const std::filesystem::path& file);

/// Writes a PNG: CV_8UC1, CV_8UC3 (RGB) or CV_16UC1 as they are; CV_32FC1 and CV_32FC3 (RGB) hold values in
/// [0, 1] and are clamped and rounded to 8 bits (NaN becomes 0). Throws InputError when the type is another
/// or the file cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& image);

/// Writes an RGB image (CV_8UC3) as JPEG of that quality, 1 to 100. Throws InputError when the type is
/// another or the file cannot be written.
void write_jpeg(const std::filesystem::path& file, const cv::Mat& image, int quality);

}  // namespace surefield
