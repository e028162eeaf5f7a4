#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace surefield {

/// What the header of an encoded image says about its pixels.
struct ImageHeader {
  enum class Kind { Png, Jpeg };
  Kind kind = Kind::Png;
  cv::Size size;
  int bits_per_pixel = 0;
};

/// Whether the bytes begin as those of a PNG image.
bool is_png(std::string_view bytes);

/// Whether they begin as those of any image that is read here: PNG, JPEG, TIFF, BMP, WebP, PNM. OpenCV may
/// have been built with decoders of more, and some of those end the program over a damaged file.
bool is_image(std::string_view bytes);

/// The header of a PNG or JPEG image; nullopt where the bytes are neither, or end before it.
std::optional<ImageHeader> read_image_header(std::string_view bytes);

/// Throws InputError, naming `name`, where so many bytes cannot hold so many pixels: the sizes in a damaged
/// header must not decide how much memory is taken.
void require_plausible(const ImageHeader& header, std::size_t bytes, const std::filesystem::path& name);

/// A PNG image reduced to the parts that hold its pixels. Throws InputError, naming `name`, where a part is
/// missing or its checksum is wrong. So libpng, which writes on stderr what it thinks of the other parts, has
/// nothing to say.
std::string pixels_of_png(std::string_view bytes, const std::filesystem::path& name);

/// A JPEG image, CV_8UC3, RGB; an empty one where it stores four inks. Throws InputError, naming `name`,
/// where it is damaged or cut off; stray bytes between its parts, which some cameras write, are no damage.
cv::Mat decode_jpeg(std::string_view bytes, const std::filesystem::path& name);

/// The numbers of a 16-bit depth image with one channel, CV_16UC1. Throws InputError, naming `name`, where
/// the bytes are anything else, damaged, or an image of another size than `expected`, where that is not
/// empty.
cv::Mat decode_depth_steps(const std::string& bytes, const std::filesystem::path& name,
                           cv::Size expected = {});

}  // namespace surefield
