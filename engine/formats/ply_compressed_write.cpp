#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/formats/gaussian_order.h"
#include "engine/formats/ply_compressed.h"
#include "engine/formats/rounded_values.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

static_assert(std::endian::native == std::endian::little,
              "PLY files are written in the byte order of the machine");

namespace surefield {

namespace {

using namespace compressed_ply;

constexpr float kLargestLogScale = 20;  // as other writers clamp; e^20 metres are far beyond any map

/// What a chunk's bounds are made of and what lies between them, for one Gaussian.
using Values = std::array<std::array<float, 3>, 3>;  // in the order of Attribute

Values values_of(const GaussianCloud& cloud, std::size_t i) {
  const float* sh = cloud.sh.data() + i * static_cast<std::size_t>(sh_coefficients(cloud.sh_degree)) * 3;
  Values values;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    values[kPosition][axis] = cloud.means[i][k];
    values[kScale][axis] = std::clamp(cloud.log_scales[i][k], -kLargestLogScale, kLargestLogScale);
    values[kColour][axis] = kHarmonic0 * sh[axis] + 0.5f;
  }
  return values;
}

/// Up to kChunk Gaussians with the bounds of their values.
struct Chunk {
  std::vector<Values> values;
  std::array<float, kBounds.size()> bounds;

  Chunk(const GaussianCloud& cloud, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values.push_back(values_of(cloud, i));
    for (std::size_t attribute : {kPosition, kScale, kColour})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto less = [&](const Values& a, const Values& b) {
          return a[attribute][axis] < b[attribute][axis];
        };
        const auto [least, greatest] = std::minmax_element(values.begin(), values.end(), less);
        bounds[low(attribute, axis)] = (*least)[attribute][axis];
        bounds[high(attribute, axis)] = (*greatest)[attribute][axis];
      }
  }

  /// Where between the bounds a value lies, in steps from 0 to `most_steps`.
  uint32_t steps(std::size_t i, std::size_t attribute, std::size_t axis, uint32_t most_steps) const {
    const double from = bounds[low(attribute, axis)], to = bounds[high(attribute, axis)];
    return to > from ? to_steps((values[i][attribute][axis] - from) / (to - from) * most_steps, most_steps)
                     : 0;
  }

  uint32_t vector(std::size_t i, std::size_t attribute) const {
    uint32_t packed = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      packed = packed << kVectorBits[axis] | steps(i, attribute, axis, most(kVectorBits[axis]));
    return packed;
  }

  uint32_t colour(std::size_t i, float logit) const {
    uint32_t packed = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      packed = packed << kColourBits | steps(i, kColour, channel, most(kColourBits));
    return packed << kColourBits | to_byte(255 * opacity_of(logit));
  }
};

/// The largest number is left out and positive; the others are at most sqrt(1/2).
uint32_t pack_rotation(const Eigen::Vector4f& rotation) {
  Eigen::Vector4d q = rotation.cast<double>().normalized();
  Eigen::Index largest = 0;
  q.cwiseAbs().maxCoeff(&largest);
  if (q[largest] < 0) q = -q;
  auto packed = static_cast<uint32_t>(largest);
  for (Eigen::Index component = 0; component < 4; ++component)
    if (component != largest)
      packed = packed << kRotationBits |
               to_steps((q[component] * std::sqrt(0.5) + 0.5) * most(kRotationBits), most(kRotationBits));
  return packed;
}

template <typename T>
void append(std::string& bytes, const T& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
}

void write_header(std::ostream& stream, const GaussianCloud& cloud, std::size_t chunks) {
  stream << "ply\nformat binary_little_endian 1.0\nelement chunk " << chunks << "\n";
  for (const char* name : kBounds) stream << "property float " << name << "\n";
  stream << "element vertex " << cloud.size() << "\n";
  for (const char* name : kPacked) stream << "property uint " << name << "\n";
  if (cloud.sh_degree > 0) stream << "element sh " << cloud.size() << "\n";
  for (int k = 0; k < 3 * (sh_coefficients(cloud.sh_degree) - 1); ++k)
    stream << "property uchar f_rest_" << k << "\n";
  stream << "end_header\n";
}

/// Red coefficients first, then green and blue ones.
std::string packed_harmonics(const GaussianCloud& cloud) {
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  std::string bytes;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      for (std::size_t k = 1; k < coefficients; ++k) {
        const float value = cloud.sh[(i * coefficients + k) * 3 + channel];
        const float steps = std::floor((value / kShRange + 1) * 128);
        bytes.push_back(static_cast<char>(to_byte(steps)));
      }
  return bytes;
}

}  // namespace

void write_compressed_ply(const std::filesystem::path& file, const GaussianCloud& unordered) {
  if (!unordered.is_consistent())
    throw UsageError("write_compressed_ply: the arrays of the cloud differ in length");
  std::vector<std::size_t> order = finite_gaussians(unordered);
  sort_along_morton_curve(unordered, order);
  const GaussianCloud cloud = select(unordered, order);
  std::string bounds, gaussians;
  for (std::size_t begin = 0; begin < cloud.size(); begin += kChunk) {
    const Chunk chunk(cloud, begin, std::min(begin + kChunk, cloud.size()));
    append(bounds, chunk.bounds);
    for (std::size_t i = 0; i < chunk.values.size(); ++i)
      append(gaussians, std::array<uint32_t, kPacked.size()>{
                            chunk.vector(i, kPosition), pack_rotation(cloud.rotations[begin + i]),
                            chunk.vector(i, kScale), chunk.colour(i, cloud.opacity_logits[begin + i])});
  }
  write_file(file, [&](std::ostream& stream) {
    write_header(stream, cloud, (cloud.size() + kChunk - 1) / kChunk);
    stream << bounds << gaussians << packed_harmonics(cloud);
  });
}

}  // namespace surefield
