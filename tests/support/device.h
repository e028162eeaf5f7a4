#pragma once

#include "engine/gpu/device.h"

namespace surefield::testing {

/// The options of device(), for tests that open a device of their own: the device that the environment
/// variable SUREFIELD_DEVICE names (as --device), with validation.
gpu::DeviceOptions device_options();

/// The device that the tests of one program share, opened at first use. At exit the program fails if
/// validation said anything.
gpu::Device& device();

/// The same, but binding with descriptor sets from a pool even where the device has push descriptors.
gpu::Device& pool_device();

}  // namespace surefield::testing
