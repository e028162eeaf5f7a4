#pragma once

#include "engine/gpu/device.h"

namespace surefield::testing {

/// The device that the tests of one program share, opened at first use with validation on. The device is
/// chosen by the environment variable SUREFIELD_DEVICE (as --device). At exit the program fails if validation
/// said anything.
gpu::Device& device();

}  // namespace surefield::testing
