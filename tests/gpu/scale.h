#pragma once

#include <string>
#include <vector>

#include "engine/gpu/recorder.h"
#include "shaders/shared/test_scale.h"

namespace surefield::testing {

/// The pass test_scale, values[i] = factor * values[i] + offsets[i], with what it takes to record it in one
/// line.
class Scale {
 public:
  explicit Scale(gpu::Device& device) : pass_(device, 64) {}

  void record(gpu::Recorder& recorder, const gpu::Array<float>& offsets, const gpu::Array<float>& values,
              uint32_t count, float factor = 1) const {
    recorder.dispatch(pass_, pass_.groups(count), {.offsets = offsets, .values = values},
                      {.count = count, .factor = factor});
  }

  const gpu::Pass<passes::test_scale>& pass() const { return pass_; }

 private:
  gpu::Pass<passes::test_scale> pass_;
};

/// A device array of `count` equal values.
inline gpu::Array<float> constant_array(gpu::Device& device, const std::string& name, uint32_t count,
                                        float value) {
  gpu::Array<float> array(device, name, count);
  array.upload(std::vector<float>(count, value));
  return array;
}

/// The range of the first `count` entries of an array, for fills and copies.
template <class T>
gpu::Slice first_entries(const gpu::Array<T>& array, uint64_t count) {
  return {&array.buffer(), 0, count * sizeof(T)};
}

}  // namespace surefield::testing
