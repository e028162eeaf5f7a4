#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/glsl_types.h"
#include "engine/splat/gaussian_cloud.h"

namespace surefield {

/// One attribute of the map with its Adam moments.
template <class T>
struct Parameter {
  gpu::Array<T> value;
  gpu::Array<T> first_moment;
  gpu::Array<T> second_moment;

  Parameter(gpu::Device& device, const std::string& name)
      : value(device, name), first_moment(device, name + " m"), second_moment(device, name + " v") {}
};

/// The Gaussians on the device: one buffer per attribute (shapes as in GaussianCloud), capacity grown in
/// blocks.
class GaussianMap {
 public:
  /// Capacity grows in steps of this many Gaussians.
  static constexpr uint32_t kBlock = 16384;

  explicit GaussianMap(gpu::Device& device);

  uint32_t size() const { return size_; }
  int sh_degree() const { return sh_degree_; }

  /// Replaces the map. Moments and statistics start at zero.
  void assign(const GaussianCloud& cloud);
  /// Adds Gaussians at the end; their moments and statistics start at zero. Throws std::invalid_argument when
  /// the degree of the spherical harmonics differs from that of a map that is not empty.
  void append(const GaussianCloud& cloud);
  /// Declares how many Gaussians the arrays hold, after a pass has rebuilt them.
  void set_size(uint32_t size);
  /// Reads the map back.
  GaussianCloud download() const;

  /// Device memory of the parameters alone (without moments), bytes.
  uint64_t parameter_bytes() const;

  Parameter<glsl::vec3> means;
  Parameter<glsl::vec3> log_scales;
  Parameter<glsl::vec4> rotations;
  Parameter<float> opacity_logits;
  Parameter<glsl::vec3> sh;              ///< sh_coefficients(sh_degree()) per Gaussian
  gpu::Array<glsl::uint> steps;          ///< Adam steps taken by each Gaussian
  gpu::Array<glsl::vec2> densification;  ///< sum of the norms of the screen gradient, times seen
  gpu::Array<glsl::uint> count;          ///< size(), for passes that read it on the device

 private:
  void reserve(uint32_t capacity);
  void write(const GaussianCloud& cloud, uint32_t first);

  gpu::Device& device_;
  uint32_t size_ = 0;
  int sh_degree_ = 0;
};

}  // namespace surefield
