// The .sens container of ScanNet, version 4, little endian: uint32 version; sensor name (uint64 length,
// bytes); intrinsics and extrinsics of colour, then of depth (4 x 4 floats each, row by row); int32 colour
// and depth compression; uint32 colour width, height, depth width, height; float depth shift (steps per
// metre); uint64 number of frames. A frame: camera-to-world (4 x 4 floats); uint64 colour and depth stamps;
// uint64 sizes of both images; the images.
#include "engine/sources/sens_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "engine/io/images.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of the file are little endian");

constexpr uint32_t kVersion = 4;
constexpr uint64_t kLongestName = 4096;
constexpr std::size_t kMostInflated = 1032;  // bytes that zlib makes of one

/// Reads numbers one after the other.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), stream_(file, std::ios::binary) {
    std::error_code error;
    size_ = std::filesystem::file_size(file, error);
    if (!stream_ || error) throw InputError(file, "cannot be opened; check its permissions");
  }

  template <typename T>
  T number() {
    T value{};
    bytes(reinterpret_cast<char*>(&value), sizeof(value));
    return value;
  }

  std::vector<double> matrix() {
    std::vector<double> rows;
    for (int i = 0; i < 16; ++i) rows.push_back(number<float>());
    return rows;
  }

  std::string text(uint64_t length) {
    if (length > left()) end_too_early();
    std::string text(length, '\0');
    bytes(text.data(), length);
    return text;
  }

  uint64_t position() { return static_cast<uint64_t>(stream_.tellg()); }
  uint64_t left() { return size_ - position(); }
  void skip(uint64_t count) { stream_.seekg(static_cast<std::streamoff>(count), std::ios::cur); }
  void go_to(uint64_t position) { stream_.seekg(static_cast<std::streamoff>(position)); }

 private:
  void bytes(char* to, uint64_t count) {
    if (!stream_.read(to, static_cast<std::streamsize>(count))) end_too_early();
  }

  [[noreturn]] void end_too_early() const {
    throw InputError(file_, "ends too early; it may not have been downloaded completely");
  }

  const std::filesystem::path& file_;
  std::ifstream stream_;
  uint64_t size_ = 0;
};

constexpr uint64_t kFrameHeader = 16 * sizeof(float) + 4 * sizeof(uint64_t);

Intrinsics intrinsics_of(const std::vector<double>& matrix, uint32_t width, uint32_t height) {
  return {static_cast<int>(width), static_cast<int>(height), matrix[0], matrix[5], matrix[2], matrix[6]};
}

void read_header(Reader& reader, SensFile& sens) {
  const auto version = reader.number<uint32_t>();
  if (version != kVersion) {
    throw InputError(sens.file,
                     fmt::format("is no .sens file of version {} (it starts with {})", kVersion, version));
  }
  const auto length = reader.number<uint64_t>();
  if (length > kLongestName) throw InputError(sens.file, "is damaged: the sensor's name is too long");
  sens.sensor = reader.text(length);
  const std::vector<double> colour = reader.matrix();
  reader.matrix();
  const std::vector<double> depth = reader.matrix();
  reader.matrix();
  sens.colour_compression = static_cast<SensColour>(reader.number<int32_t>());
  sens.depth_compression = static_cast<SensDepth>(reader.number<int32_t>());
  std::array<uint32_t, 4> sides{};
  for (uint32_t& side : sides) {
    side = reader.number<uint32_t>();
    if (side == 0 || side > uint32_t{kLargestSide})
      throw InputError(sens.file, "is damaged: no size of an image");
  }
  sens.colour = intrinsics_of(colour, sides[0], sides[1]);
  sens.depth = intrinsics_of(depth, sides[2], sides[3]);
  const auto steps = static_cast<double>(reader.number<float>());
  if (!(steps > 0) || !(sens.depth.fx > 0) || !(sens.depth.fy > 0)) {
    throw InputError(sens.file, "is damaged: depth shift and focal lengths must be positive");
  }
  sens.depth_unit = 1 / steps;
  sens.promised = reader.number<uint64_t>();
}

void check_compression(const SensFile& sens) {
  const bool colour_known =
      sens.colour_compression >= SensColour::Raw && sens.colour_compression <= SensColour::Jpeg;
  if (!colour_known) {
    throw InputError(sens.file, fmt::format("stores colour in an unknown way ({})",
                                            static_cast<int32_t>(sens.colour_compression)));
  }
  if (sens.depth_compression == SensDepth::Occi) {
    throw InputError(
        sens.file,
        "stores depth as occi_ushort, which only the recording device's library reads; export it to "
        "color/, depth/, pose/, intrinsic/ with that library's tool");
  }
  if (sens.depth_compression != SensDepth::Raw && sens.depth_compression != SensDepth::Zlib) {
    throw InputError(sens.file, fmt::format("stores depth in an unknown way ({})",
                                            static_cast<int32_t>(sens.depth_compression)));
  }
}

/// The frames that are complete, up to the number that the header announces.
void find_frames(Reader& reader, SensFile& sens) {
  for (uint64_t i = 0; i < sens.promised && reader.left() >= kFrameHeader; ++i) {
    SensFrame frame;
    if (const auto pose = rigid_from_rows(reader.matrix())) {
      frame.camera_to_world = *pose;
    } else {
      frame.camera_to_world.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    reader.number<uint64_t>();  // stamps, of a unit that the format leaves open
    reader.number<uint64_t>();
    frame.colour_bytes = reader.number<uint64_t>();
    frame.depth_bytes = reader.number<uint64_t>();
    frame.colour_at = reader.position();
    if (frame.colour_bytes > reader.left() || frame.depth_bytes > reader.left() - frame.colour_bytes) break;
    reader.skip(frame.colour_bytes + frame.depth_bytes);
    sens.frames.push_back(frame);
  }
  if (sens.frames.empty()) throw InputError(sens.file, "holds no complete frame");
}

/// `bytes` as an image of `type` and the size of `camera`.
cv::Mat raw_image(const std::string& bytes, const Intrinsics& camera, int type,
                  const std::filesystem::path& name) {
  const std::size_t expected = static_cast<std::size_t>(camera.width) * camera.height * CV_ELEM_SIZE(type);
  if (bytes.size() != expected) throw InputError(name, "has the wrong size in bytes");
  cv::Mat image(camera.height, camera.width, type);
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(image.data));
  return image;
}

cv::Mat inflate(const std::string& bytes, const Intrinsics& camera, const std::filesystem::path& name) {
  const std::size_t expected = static_cast<std::size_t>(camera.width) * camera.height * sizeof(uint16_t);
  if (expected > kMostInflated * bytes.size())
    throw InputError(name, "has too few bytes for a depth image of that size");
  std::string steps(expected, '\0');
  uLongf size = static_cast<uLongf>(steps.size());
  const int result =
      uncompress(reinterpret_cast<Bytef*>(steps.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                 static_cast<uLong>(bytes.size()));
  if (result != Z_OK || size != steps.size()) throw InputError(name, "the depth image is damaged");
  return raw_image(steps, camera, CV_16UC1, name);
}

}  // namespace

SensFile read_sens_file(const std::filesystem::path& file) {
  SensFile sens;
  sens.file = file;
  Reader reader(file);
  read_header(reader, sens);
  check_compression(sens);
  find_frames(reader, sens);
  return sens;
}

Frame read_sens_frame(const SensFile& sens, int i) {
  const SensFrame& stored = sens.frames.at(static_cast<std::size_t>(i));
  const std::filesystem::path name = fmt::format("{} (frame {})", sens.file.string(), i);
  Reader reader(sens.file);
  reader.go_to(stored.colour_at);
  const std::string colour = reader.text(stored.colour_bytes);
  const std::string depth = reader.text(stored.depth_bytes);
  Frame frame;
  frame.index = i;
  frame.timestamp = i;
  frame.colour = sens.colour_compression == SensColour::Raw
                     ? raw_image(colour, sens.colour, CV_8UC3, name)
                     : decode_colour(colour, name, cv::Size(sens.colour.width, sens.colour.height));
  cv::resize(frame.colour, frame.colour, cv::Size(sens.depth.width, sens.depth.height), 0, 0, cv::INTER_AREA);
  const cv::Mat steps = sens.depth_compression == SensDepth::Raw
                            ? raw_image(depth, sens.depth, CV_16UC1, name)
                            : inflate(depth, sens.depth, name);
  frame.depth = depth_in_metres(steps, {sens.depth_unit});
  return frame;
}

}  // namespace surefield
