#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "engine/formats/gzip.h"
#include "engine/formats/rounded_values.h"
#include "engine/formats/spz.h"
#include "engine/formats/spz_layout.h"
#include "engine/formats/turned_axes.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

static_assert(std::endian::native == std::endian::little,
              "SPZ files are read in the byte order of the machine");

namespace surefield {

namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kNewest = 3;
constexpr uint32_t kFewGaussians = 1000000;  // whose memory is of no concern, however well they compress
constexpr std::size_t kMostExtension = std::size_t{1}
                                       << 20;  // bytes behind the arrays, beyond their own length

std::string read_compressed(const std::filesystem::path& file) {
  std::string compressed = read_file(file);
  if (compressed.starts_with("NGSP"))
    throw InputError(file, "is an SPZ file of version 4 or later; convert it to version 3 or to PLY");
  if (!starts_as_gzip(compressed)) throw InputError(file, "is no SPZ file: it is not gzip-compressed");
  return compressed;
}

std::size_t rotation_bytes(const spz::Header& header) {
  return header.version == 3 ? 4 : 3;
}

/// Checks the number of Gaussians against the bytes at hand before memory is taken for them.
void check_count(const std::filesystem::path& file, const spz::Header& header,
                 const std::string& compressed) {
  const std::size_t bytes = 9 + 1 + 3 + 3 + rotation_bytes(header) +
                            static_cast<std::size_t>(sh_coefficients(header.sh_degree) - 1) * 3;
  if (header.count > GzipReader::most_bytes(compressed.size()) / bytes)
    throw InputError(file, fmt::format("holds fewer Gaussians than its header says ({}); the file is damaged",
                                       header.count));
  if (header.count > kFewGaussians && compressed.size() < header.count)
    throw InputError(file,
                     fmt::format("claims {} Gaussians in {} bytes, where maps take 10 bytes and more for "
                                 "each; the file is damaged, or made to fill the memory",
                                 header.count, compressed.size()));
  const std::size_t length = sizeof(header) + header.count * bytes;
  GzipReader::require_length(file, compressed, length, 2 * length + kMostExtension);
}

spz::Header read_header(const std::filesystem::path& file, GzipReader& gzip) {
  spz::Header header;
  std::memcpy(&header, gzip.read(sizeof(header)).data(), sizeof(header));
  if (header.magic != spz::kMagic) throw InputError(file, "is no SPZ file: \"NGSP\" is missing");
  if (header.version != 2 && header.version != kNewest)
    throw InputError(file,
                     fmt::format("is an SPZ file of version {}; only 2 and 3 are read, convert it to one "
                                 "of them or to PLY",
                                 header.version));
  if (header.sh_degree > 3)
    throw InputError(file,
                     fmt::format("has SH of degree {}; only 0 to 3 are possible here", header.sh_degree));
  if (header.fractional_bits > 23)
    throw InputError(file, fmt::format("is damaged: {} bits after the point", header.fractional_bits));
  return header;
}

float coordinate(const uint8_t* bytes, int fractional_bits) {
  const uint32_t fixed = static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8 |
                         static_cast<uint32_t>(bytes[2]) << 16;
  const int32_t value = static_cast<int32_t>(fixed) - (fixed & 0x800000 ? 1 << 24 : 0);
  return static_cast<float>(value) / static_cast<float>(1 << fractional_bits);
}

/// Version 2: x, y and z; w is positive.
Eigen::Vector4f rotation_of_three(const uint8_t* bytes) {
  Eigen::Vector4f q;
  for (int axis = 0; axis < 3; ++axis) q[axis + 1] = static_cast<float>(bytes[axis]) / 127.5f - 1;
  q[0] = std::sqrt(std::max(0.0f, 1 - q.tail<3>().squaredNorm()));
  return q;
}

/// Version 3: the three smallest of x, y, z, w, the last in the lowest bits, each a sign and 9 bits of
/// magnitude in units of sqrt(1/2) / 511; the highest two bits tell which is missing. It is positive.
Eigen::Vector4f rotation_of_smallest(const uint8_t* bytes) {
  uint32_t packed = 0;
  std::memcpy(&packed, bytes, sizeof(packed));
  const int missing = static_cast<int>(packed >> 30);
  Eigen::Vector4f q = Eigen::Vector4f::Zero();  // w, x, y, z
  for (int component = 3; component >= 0; --component) {
    if (component == missing) continue;
    const float magnitude = static_cast<float>(packed & 511) / 511 * std::sqrt(0.5f);
    q[(component + 1) % 4] = packed & 512 ? -magnitude : magnitude;
    packed >>= 10;
  }
  q[(missing + 1) % 4] = std::sqrt(std::max(0.0f, 1 - q.squaredNorm()));
  return q;
}

void read_shapes(GzipReader& gzip, const spz::Header& header, GaussianCloud& cloud) {
  const Bytes scales = gzip.read(3 * cloud.size());
  const std::size_t width = rotation_bytes(header);
  const Bytes rotations = gzip.read(width * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      cloud.log_scales[i][static_cast<Eigen::Index>(axis)] =
          static_cast<float>(scales[3 * i + axis]) / spz::kScaleSteps - spz::kScaleOffset;
    const uint8_t* bytes = rotations.data() + width * i;
    Eigen::Vector4f q = header.version == 2 ? rotation_of_three(bytes) : rotation_of_smallest(bytes);
    for (int axis = 0; axis < 3; ++axis) q[axis + 1] *= kTurnedAxes[static_cast<std::size_t>(axis)];
    cloud.rotations[i] = q;
  }
}

void read_harmonics(GzipReader& gzip, GaussianCloud& cloud) {
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  const Bytes bytes = gzip.read((coefficients - 1) * 3 * cloud.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t k = 1; k < coefficients; ++k)
      for (std::size_t channel = 0; channel < 3; ++channel)
        cloud.sh[(i * coefficients + k) * 3 + channel] =
            (static_cast<float>(bytes[next++]) - 128) / 128 * kTurnedHarmonics[k - 1];
}

void read_looks(GzipReader& gzip, GaussianCloud& cloud) {
  const Bytes alphas = gzip.read(cloud.size());
  const Bytes colours = gzip.read(3 * cloud.size());
  const auto stride = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree)) * 3;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.opacity_logits[i] = logit_of_byte(alphas[i]);
    for (std::size_t channel = 0; channel < 3; ++channel)
      cloud.sh[i * stride + channel] =
          (static_cast<float>(colours[3 * i + channel]) / 255 - 0.5f) / spz::kColourScale;
  }
}

}  // namespace

GaussianCloud read_spz(const std::filesystem::path& file) {
  const std::string compressed = read_compressed(file);
  GzipReader gzip(file, compressed);
  const spz::Header header = read_header(file, gzip);
  check_count(file, header, compressed);
  GaussianCloud cloud;
  cloud.sh_degree = header.sh_degree;
  cloud.resize(header.count);
  const Bytes positions = gzip.read(9 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      cloud.means[i][static_cast<Eigen::Index>(axis)] =
          coordinate(positions.data() + 9 * i + 3 * axis, header.fractional_bits) * kTurnedAxes[axis];
  read_looks(gzip, cloud);
  read_shapes(gzip, header, cloud);
  read_harmonics(gzip, cloud);
  gzip.finish();
  return cloud;
}

}  // namespace surefield
