#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/glsl_types.h"
#include "engine/types/depth_model.h"
#include "engine/types/gaussian_cloud.h"

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
  DepthModel depth_model() const { return depth_model_; }

  /// Replaces the map by Gaussians whose depth over their footprints is `depth_model`, which stays that of
  /// the map until the next assign(). Moments and statistics start at zero.
  void assign(const GaussianCloud& cloud, DepthModel depth_model = DepthModel::Plane);
  /// Adds Gaussians at the end; their moments and statistics start at zero. Throws UsageError when
  /// the degree of the spherical harmonics differs from that of a map that is not empty, or the arrays of the
  /// cloud differ in length.
  void append(const GaussianCloud& cloud);
  /// Declares how many Gaussians the arrays hold, after a pass has rebuilt them.
  void set_size(uint32_t size);
  /// Reads the map back.
  GaussianCloud download() const;

  /// Bytes of the parameters of one Gaussian alone, without moments.
  uint64_t parameter_bytes() const;

  /// Calls visit(array, words, state) for every array that describes Gaussians: `words` is how many 32-bit
  /// words of it belong to one; `state` tells what a newborn Gaussian has none of (its uncertainty, moments
  /// and statistics) from the parameters, which come first.
  template <class Visit>
  void for_each_array(Visit&& visit);

  /// 32-bit words that describe one Gaussian: a record, its parts in the order of for_each_array().
  uint32_t record_words() const;
  /// Where in a record the part of one of the map's arrays begins.
  template <class T>
  uint32_t word_of(const gpu::Array<T>& array);
  /// Reads everything about the Gaussians from `first` on, one record after the other.
  std::vector<uint32_t> read_records(uint32_t first);
  /// Adds Gaussians at the end as they were when they were read.
  void append_records(std::span<const uint32_t> records);

  Parameter<glsl::vec3> means;
  Parameter<glsl::vec3> log_scales;
  Parameter<glsl::vec4> rotations;
  Parameter<float> opacity_logits;
  Parameter<glsl::vec3> sh;              ///< sh_coefficients(sh_degree()) per Gaussian
  gpu::Array<float> uncertainty;         ///< as in GaussianCloud; that of a newborn Gaussian is 0
  gpu::Array<float> sampling;            ///< as in GaussianCloud
  gpu::Array<glsl::uint> anchors;        ///< as in GaussianCloud
  gpu::Array<glsl::uint> steps;          ///< Adam steps taken by each Gaussian
  gpu::Array<glsl::vec2> densification;  ///< sum of the norms of the screen gradient, times seen
  gpu::Array<glsl::uint> count;          ///< size(), for passes that read it on the device

 private:
  void reserve(uint32_t capacity);
  void write(const GaussianCloud& cloud, uint32_t first);

  gpu::Device& device_;
  uint32_t size_ = 0;
  int sh_degree_ = 0;
  DepthModel depth_model_ = DepthModel::Plane;
};

/// Adds the parameters, sampling, anchors and uncertainties of records of GaussianMap to a cloud of the same SH
/// degree.
void append_to(GaussianCloud& cloud, std::span<const uint32_t> records, uint32_t record_words);

template <class Visit>
void GaussianMap::for_each_array(Visit&& visit) {
  const auto sh_words = 3 * static_cast<uint32_t>(sh_coefficients(sh_degree_));
  visit(means.value, 3, false);
  visit(log_scales.value, 3, false);
  visit(rotations.value, 4, false);
  visit(opacity_logits.value, 1, false);
  visit(sh.value, sh_words, false);
  visit(sampling, 1, false);
  visit(anchors, 1, false);
  visit(uncertainty, 1, true);
  const auto moments = [&](auto& parameter, uint32_t words) {
    visit(parameter.first_moment, words, true);
    visit(parameter.second_moment, words, true);
  };
  moments(means, 3);
  moments(log_scales, 3);
  moments(rotations, 4);
  moments(opacity_logits, 1);
  moments(sh, sh_words);
  visit(steps, 1, true);
  visit(densification, 2, true);
}

template <class T>
uint32_t GaussianMap::word_of(const gpu::Array<T>& array) {
  uint32_t offset = 0, found = 0;
  for_each_array([&](const auto& other, uint32_t words, bool) {
    if (static_cast<const void*>(&other) == &array) found = offset;
    offset += words;
  });
  return found;
}

}  // namespace surefield
