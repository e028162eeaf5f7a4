#include "engine/splat/gaussian_map.h"

#include <algorithm>
#include <cstring>

#include "engine/gpu/recorder.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

using glsl::vec3;
using glsl::vec4;

// Eigen's fixed vectors and the GLSL types have the same bytes.
std::span<const vec3> as_vec3(const std::vector<Eigen::Vector3f>& v) {
  return {reinterpret_cast<const vec3*>(v.data()), v.size()};
}

/// Clears the entries [first, first + count) of an array.
template <class T>
void clear(gpu::Recorder& recorder, const gpu::Array<T>& array, uint64_t first, uint64_t count) {
  if (count) recorder.fill({&array.buffer(), first * sizeof(T), count * sizeof(T)}, 0);
}

template <class T>
void write_parameter(gpu::Recorder& recorder, Parameter<T>& parameter, std::span<const T> values,
                     uint64_t first) {
  parameter.value.upload(values, first);
  clear(recorder, parameter.first_moment, first, values.size());
  clear(recorder, parameter.second_moment, first, values.size());
}

template <class T>
void reserve_parameter(Parameter<T>& parameter, uint64_t count) {
  parameter.value.reserve(count, true);
  parameter.first_moment.reserve(count, true);
  parameter.second_moment.reserve(count, true);
}

}  // namespace

GaussianMap::GaussianMap(gpu::Device& device)
    : means(device, "means"),
      log_scales(device, "log scales"),
      rotations(device, "rotations"),
      opacity_logits(device, "opacity logits"),
      sh(device, "spherical harmonics"),
      uncertainty(device, "uncertainties"),
      sampling(device, "sampling"),
      anchors(device, "anchors"),
      steps(device, "Adam steps"),
      densification(device, "densification statistics"),
      count(device, "Gaussian count"),
      device_(device) {
  assign({});
}

void GaussianMap::reserve(uint32_t capacity) {
  const uint64_t blocks = (static_cast<uint64_t>(capacity) + kBlock - 1) / kBlock * kBlock;
  reserve_parameter(means, blocks);
  reserve_parameter(log_scales, blocks);
  reserve_parameter(rotations, blocks);
  reserve_parameter(opacity_logits, blocks);
  reserve_parameter(sh, blocks * sh_coefficients(sh_degree_));
  uncertainty.reserve(blocks, true);
  sampling.reserve(blocks, true);
  anchors.reserve(blocks, true);
  steps.reserve(blocks, true);
  densification.reserve(blocks, true);
}

void GaussianMap::assign(const GaussianCloud& cloud, DepthModel depth_model) {
  size_ = 0;
  sh_degree_ = cloud.sh_degree;
  depth_model_ = depth_model;
  append(cloud);
}

void GaussianMap::append(const GaussianCloud& cloud) {
  if (cloud.sh_degree != sh_degree_) throw UsageError("the clouds have different SH degrees");
  if (!cloud.is_consistent()) throw UsageError("the arrays of the cloud differ in length");
  const uint32_t first = size_;
  reserve(first + static_cast<uint32_t>(cloud.size()));
  write(cloud, first);
  set_size(first + static_cast<uint32_t>(cloud.size()));
}

void GaussianMap::set_size(uint32_t size) {
  size_ = size;
  count.upload(std::span(&size_, 1));
}

void GaussianMap::write(const GaussianCloud& cloud, uint32_t first) {
  const uint64_t coefficients = sh_coefficients(sh_degree_);
  gpu::Recorder recorder(device_);
  write_parameter(recorder, means, as_vec3(cloud.means), first);
  write_parameter(recorder, log_scales, as_vec3(cloud.log_scales), first);
  write_parameter(recorder, rotations,
                  std::span(reinterpret_cast<const vec4*>(cloud.rotations.data()), cloud.size()), first);
  write_parameter(recorder, opacity_logits, std::span(cloud.opacity_logits), first);
  write_parameter(recorder, sh,
                  std::span(reinterpret_cast<const vec3*>(cloud.sh.data()), cloud.size() * coefficients),
                  first * coefficients);
  uncertainty.upload(std::span(cloud.uncertainty), first);
  sampling.upload(std::span(cloud.sampling), first);
  anchors.upload(std::span(cloud.anchors), first);
  clear(recorder, steps, first, cloud.size());
  clear(recorder, densification, first, cloud.size());
  recorder.submit();
}

GaussianCloud GaussianMap::download() const {
  GaussianCloud cloud;
  cloud.sh_degree = sh_degree_;
  cloud.resize(size_);
  means.value.buffer().download(cloud.means.data(), 0, size_ * sizeof(vec3));
  log_scales.value.buffer().download(cloud.log_scales.data(), 0, size_ * sizeof(vec3));
  rotations.value.buffer().download(cloud.rotations.data(), 0, size_ * sizeof(vec4));
  opacity_logits.value.buffer().download(cloud.opacity_logits.data(), 0, size_ * sizeof(float));
  sh.value.buffer().download(cloud.sh.data(), 0, cloud.sh.size() * sizeof(float));
  uncertainty.buffer().download(cloud.uncertainty.data(), 0, size_ * sizeof(float));
  sampling.buffer().download(cloud.sampling.data(), 0, size_ * sizeof(float));
  anchors.buffer().download(cloud.anchors.data(), 0, size_ * sizeof(uint32_t));
  return cloud;
}

uint64_t GaussianMap::parameter_bytes() const {
  return 2 * sizeof(vec3) + sizeof(vec4) + sizeof(float) + sh_coefficients(sh_degree_) * sizeof(vec3);
}

uint32_t GaussianMap::record_words() const {
  const auto parameters = static_cast<uint32_t>(parameter_bytes() / sizeof(uint32_t));
  return 3 * parameters + 6;  // each with two moments; sampling, anchor, uncertainty, steps and statistics
}

std::vector<uint32_t> GaussianMap::read_records(uint32_t first) {
  const uint32_t taken = size_ - first, stride = record_words();
  std::vector<uint32_t> records(std::size_t{taken} * stride), column;
  uint32_t offset = 0;
  for_each_array([&](const auto& array, uint32_t words, bool) {
    column.resize(std::size_t{taken} * words);
    array.buffer().download(column.data(), uint64_t{first} * words * sizeof(uint32_t),
                            column.size() * sizeof(uint32_t));
    for (std::size_t i = 0; i < taken; ++i)
      std::copy_n(&column[i * words], words, &records[i * stride + offset]);
    offset += words;
  });
  return records;
}

void GaussianMap::append_records(std::span<const uint32_t> records) {
  const uint32_t stride = record_words(), added = static_cast<uint32_t>(records.size() / stride);
  reserve(size_ + added);
  std::vector<uint32_t> column;
  uint32_t offset = 0;
  for_each_array([&](auto& array, uint32_t words, bool) {
    column.resize(std::size_t{added} * words);
    for (std::size_t i = 0; i < added; ++i)
      std::copy_n(&records[i * stride + offset], words, &column[i * words]);
    array.buffer().upload(column.data(), uint64_t{size_} * words * sizeof(uint32_t),
                          column.size() * sizeof(uint32_t));
    offset += words;
  });
  set_size(size_ + added);
}

void append_to(GaussianCloud& cloud, std::span<const uint32_t> records, uint32_t record_words) {
  const std::size_t before = cloud.size(), count = records.size() / record_words;
  const auto sh_floats = 3 * static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  cloud.resize(before + count);
  for (std::size_t i = 0; i < count; ++i) {
    const uint32_t* from = &records[i * record_words];
    const auto take = [&from](void* to, std::size_t words) {
      std::memcpy(to, from, words * sizeof(uint32_t));
      from += words;
    };
    take(&cloud.means[before + i], 3);
    take(&cloud.log_scales[before + i], 3);
    take(&cloud.rotations[before + i], 4);
    take(&cloud.opacity_logits[before + i], 1);
    take(&cloud.sh[(before + i) * sh_floats], sh_floats);
    take(&cloud.sampling[before + i], 1);
    take(&cloud.anchors[before + i], 1);
    take(&cloud.uncertainty[before + i], 1);
  }
}

}  // namespace surefield
