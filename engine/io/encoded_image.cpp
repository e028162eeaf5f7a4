#include "engine/io/encoded_image.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kChunkFrame = 12;  // length, type and checksum around the data of a PNG's chunk
constexpr std::size_t kPngHeader = 13;
constexpr double kMostInflated = 1032;    // bytes that deflate makes of one
constexpr double kMostJpegPixels = 1000;  // that a byte of JPEG data stands for; a black image has some 170

uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  uint32_t number = 0;
  for (std::size_t i = 0; i < count; ++i) number = number << 8 | static_cast<uint8_t>(bytes[at + i]);
  return number;
}

std::optional<ImageHeader> read_png_header(std::string_view bytes) {
  if (bytes.size() < kPngSignature.size() + kChunkFrame + kPngHeader) return std::nullopt;
  const std::string_view header = bytes.substr(kPngSignature.size() + 8, kPngHeader);
  constexpr std::array<int, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};  // by the type of colours
  const auto type = static_cast<std::size_t>(header[9]);
  if (type >= kChannels.size()) return std::nullopt;
  const cv::Size size(static_cast<int>(big_endian(header, 0, 4)), static_cast<int>(big_endian(header, 4, 4)));
  return ImageHeader{ImageHeader::Kind::Png, size, kChannels[type] * header[8]};
}

/// Goes from segment to segment up to the one that starts the frame.
std::optional<ImageHeader> read_jpeg_header(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 9 < bytes.size()) {
    if (bytes[at] != '\xff') {
      ++at;  // stray bytes
      continue;
    }
    const auto marker = static_cast<uint8_t>(bytes[at + 1]);
    const bool starts_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (starts_frame) {
      const cv::Size size(static_cast<int>(big_endian(bytes, at + 7, 2)),
                          static_cast<int>(big_endian(bytes, at + 5, 2)));
      return ImageHeader{ImageHeader::Kind::Jpeg, size, 8 * static_cast<uint8_t>(bytes[at + 9])};
    }
    const bool alone = marker == 0xff || marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8);
    at += marker == 0xff ? 1 : alone ? 2 : 2 + big_endian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const std::filesystem::path& name, const std::string& problem) {
  throw InputError(name, "is damaged: " + problem);
}

}  // namespace

bool is_png(std::string_view bytes) {
  return bytes.starts_with(kPngSignature);
}

bool is_image(std::string_view bytes) {
  using namespace std::string_view_literals;
  for (const std::string_view signature : {kPngSignature, "\xff\xd8\xff"sv, "II*\0"sv, "MM\0*"sv, "BM"sv})
    if (bytes.starts_with(signature)) return true;
  const bool webp = bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP";
  const bool pnm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6';
  return webp || pnm;
}

std::optional<ImageHeader> read_image_header(std::string_view bytes) {
  if (is_png(bytes)) return read_png_header(bytes);
  if (bytes.starts_with("\xff\xd8")) return read_jpeg_header(bytes);
  return std::nullopt;
}

void require_plausible(const ImageHeader& header, std::size_t bytes, const std::filesystem::path& name) {
  const double pixels = static_cast<double>(header.size.width) * header.size.height;
  const double most = header.kind == ImageHeader::Kind::Png
                          ? kMostInflated * 8 * static_cast<double>(bytes) / header.bits_per_pixel
                          : kMostJpegPixels * static_cast<double>(bytes);
  if (header.size.width > 0 && header.size.height > 0 && pixels <= most) return;
  refuse(name, fmt::format("{} bytes cannot hold the {} x {} pixels that it announces", bytes,
                           header.size.width, header.size.height));
}

std::string pixels_of_png(std::string_view bytes, const std::filesystem::path& name) {
  std::string kept(kPngSignature);
  std::string_view rest = bytes.substr(kPngSignature.size());
  while (rest.size() >= kChunkFrame) {
    const std::size_t length = big_endian(rest, 0, 4);
    if (length > rest.size() - kChunkFrame) break;
    const std::string_view type = rest.substr(4, 4), typed = rest.substr(4, 4 + length);
    if (type == "IHDR" || type == "PLTE" || type == "IDAT" || type == "IEND") {
      const auto checksum =
          crc32(0, reinterpret_cast<const Bytef*>(typed.data()), static_cast<uInt>(typed.size()));
      if (checksum != big_endian(rest, 8 + length, 4)) refuse(name, "a checksum is wrong");
      kept += rest.substr(0, kChunkFrame + length);
    }
    if (type == "IEND") return kept;
    rest.remove_prefix(kChunkFrame + length);
  }
  throw InputError(name, "is not a readable image: it was cut off");
}

}  // namespace surefield
