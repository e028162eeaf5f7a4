#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/formats/ply_compressed.h"
#include "engine/formats/ply_records.h"
#include "engine/formats/rounded_values.h"
#include "engine/formats/usable_gaussians.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

using namespace compressed_ply;
using Columns = std::vector<std::size_t>;
using Bounds = std::array<double, kBounds.size()>;

/// The columns of these properties. Throws InputError where one is missing or of another type.
template <typename Names>
Columns columns_of(const std::filesystem::path& file, const PlyElement& element, const Names& names,
                   PlyType type) {
  Columns columns;
  for (const auto& name : names) {
    const auto found = element.find(name);
    if (!found || element.properties[*found].list_length || element.properties[*found].type != type)
      throw InputError(file,
                       fmt::format("is no compressed map: its element {} has no property {} of the type {}",
                                   element.name, name,
                                   type == PlyType::float32  ? "float"
                                   : type == PlyType::uint32 ? "uint"
                                                             : "uchar"));
    columns.push_back(*found);
  }
  return columns;
}

/// The bounds of all chunks. Older files have none for colours, which then go from 0 to 1.
std::vector<Bounds> read_chunks(const std::filesystem::path& file, const PlyElement& chunks,
                                PlyRecordReader& reader) {
  const bool coloured = chunks.find(kBounds[low(kColour, 0)]).has_value();
  const std::span names(kBounds.data(), coloured ? kBounds.size() : low(kColour, 0));
  const Columns columns = columns_of(file, chunks, names, PlyType::float32);
  std::vector<Bounds> all(chunks.count, Bounds{});
  PlyRecord record;
  for (Bounds& bounds : all) {
    std::fill(bounds.begin() + high(kColour, 0), bounds.end(), 1.0);
    reader.next(chunks, record);
    for (std::size_t k = 0; k < columns.size(); ++k) bounds[k] = record.property(columns[k])[0];
  }
  return all;
}

/// The bits of a packed number; 0 where a text file has one that is none.
uint32_t packed_bits(double number) {
  return number >= 0 && number <= 4294967295.0 ? static_cast<uint32_t>(number) : 0;
}

/// Takes `bits` from the lower end of `packed`, as a share of the largest value.
double take(uint32_t& packed, int bits) {
  const double share = static_cast<double>(packed & most(bits)) / most(bits);
  packed >>= bits;
  return share;
}

/// Where between its chunk's bounds a value lies. At a bound the other one, which may be infinite, is left
/// out.
float between(const Bounds& bounds, std::size_t attribute, std::size_t axis, double share) {
  const double from = bounds[low(attribute, axis)], to = bounds[high(attribute, axis)];
  if (share <= 0 || from == to) return static_cast<float>(from);
  return static_cast<float>(share >= 1 ? to : from * (1 - share) + to * share);
}

Eigen::Vector3f unpack_vector(uint32_t packed, const Bounds& bounds, std::size_t attribute) {
  Eigen::Vector3f vector;
  for (std::size_t axis = 3; axis-- > 0;)
    vector[static_cast<Eigen::Index>(axis)] =
        between(bounds, attribute, axis, take(packed, kVectorBits[axis]));
  return vector;
}

/// A quaternion w, x, y, z.
Eigen::Vector4f unpack_rotation(uint32_t packed) {
  const auto largest = static_cast<Eigen::Index>(packed >> 3 * kRotationBits);
  Eigen::Vector4f q = Eigen::Vector4f::Zero();
  for (Eigen::Index component = 3; component >= 0; --component)
    if (component != largest)
      q[component] = static_cast<float>((take(packed, kRotationBits) - 0.5) * std::sqrt(2.0));
  q[largest] = std::sqrt(std::max(0.0f, 1 - q.squaredNorm()));
  return q;
}

void unpack_colour(uint32_t packed, const Bounds& bounds, GaussianCloud& cloud, std::size_t i) {
  cloud.opacity_logits[i] = logit_of_byte(static_cast<uint8_t>(packed & most(kColourBits)));
  packed >>= kColourBits;
  float* sh = cloud.sh.data() + i * static_cast<std::size_t>(sh_coefficients(cloud.sh_degree)) * 3;
  for (std::size_t channel = 3; channel-- > 0;)
    sh[channel] = (between(bounds, kColour, channel, take(packed, kColourBits)) - 0.5f) / kHarmonic0;
}

void read_gaussians(const PlyElement& vertices, const Columns& columns, const std::vector<Bounds>& chunks,
                    PlyRecordReader& reader, GaussianCloud& cloud) {
  PlyRecord record;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    reader.next(vertices, record);
    const auto packed = [&](std::size_t k) { return packed_bits(record.property(columns[k])[0]); };
    const Bounds& bounds = chunks[i / kChunk];
    cloud.means[i] = unpack_vector(packed(0), bounds, kPosition);
    cloud.rotations[i] = unpack_rotation(packed(1));
    cloud.log_scales[i] = unpack_vector(packed(2), bounds, kScale);
    unpack_colour(packed(3), bounds, cloud, i);
  }
}

/// The outermost of the 256 steps stand for the ends of the range, the others for their middles.
float harmonic(double byte) {
  const double share = byte <= 0 ? 0 : byte >= 255 ? 1 : (byte + 0.5) / 256;
  return static_cast<float>((2 * share - 1) * kShRange);
}

/// The file has all of a Gaussian's red coefficients, then its green and its blue ones.
void read_packed_harmonics(const std::filesystem::path& file, const PlyElement& element,
                           PlyRecordReader& reader, GaussianCloud& cloud) {
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  std::vector<std::string> names;
  for (std::size_t k = 0; k < 3 * (coefficients - 1); ++k) names.push_back("f_rest_" + std::to_string(k));
  const Columns columns = columns_of(file, element, names, PlyType::uint8);
  PlyRecord record;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    reader.next(element, record);
    float* sh = cloud.sh.data() + i * coefficients * 3;
    for (std::size_t channel = 0; channel < 3; ++channel)
      for (std::size_t k = 1; k < coefficients; ++k)
        sh[3 * k + channel] = harmonic(record.property(columns[channel * (coefficients - 1) + k - 1])[0]);
  }
}

int degree_of(const std::filesystem::path& file, const PlyElement& harmonics, std::size_t gaussians) {
  if (harmonics.count != gaussians)
    throw InputError(file, fmt::format("is damaged: it has {} Gaussians, but SH coefficients of {}",
                                       gaussians, harmonics.count));
  for (int degree = 1; degree <= 3; ++degree)
    if (harmonics.properties.size() == 3 * static_cast<std::size_t>(sh_coefficients(degree) - 1))
      return degree;
  throw InputError(file, fmt::format("has {} SH coefficients a Gaussian; only 9, 24 or 45 are possible",
                                     harmonics.properties.size()));
}

}  // namespace

PlyCloud read_compressed_ply(const std::filesystem::path& file, const PlyHeader& header) {
  const PlyElement& chunks = header.elements.front();
  const PlyElement& vertices = header.vertices();
  if (vertices.count > chunks.count * kChunk)
    throw InputError(file, fmt::format("is damaged: {} Gaussians need more than its {} chunks",
                                       vertices.count, chunks.count));
  const bool has_harmonics = header.elements.size() > 2 && header.elements[2].name == "sh";
  GaussianCloud cloud;
  if (has_harmonics) cloud.sh_degree = degree_of(file, header.elements[2], vertices.count);
  PlyRecordReader reader(file, header);
  const std::vector<Bounds> bounds = read_chunks(file, chunks, reader);
  // Memory is taken once it is known that each Gaussian has 16 bytes in the file.
  const Columns columns = columns_of(file, vertices, kPacked, PlyType::uint32);
  cloud.resize(vertices.count);
  read_gaussians(vertices, columns, bounds, reader, cloud);
  if (has_harmonics) read_packed_harmonics(file, header.elements[2], reader, cloud);
  const LeftOutGaussians left_out = keep_usable(cloud);
  return {std::move(cloud), left_out.broken, left_out.invisible};
}

}  // namespace surefield
