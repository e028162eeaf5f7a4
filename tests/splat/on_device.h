#pragma once

#include <string>
#include <vector>

#include "engine/gpu/buffer.h"
#include "tests/support/device.h"

namespace surefield::testing {

/// An array of the tests' device with these values.
template <class T>
gpu::Array<T> on_device(const std::string& name, const std::vector<T>& values) {
  gpu::Array<T> array(device(), name, values.size());
  array.upload(values);
  return array;
}

}  // namespace surefield::testing
