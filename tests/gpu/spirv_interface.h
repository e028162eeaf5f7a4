#pragma once

#include <cstdint>
#include <map>
#include <span>

namespace surefield::testing {

/// One storage buffer as a SPIR-V module declares it.
struct SpirvBinding {
  uint32_t set = 0;
  uint32_t stride = 0;  ///< bytes of one entry of its array
  bool read_only = false;
};

/// What a compute module expects from the outside.
struct SpirvInterface {
  std::map<uint32_t, SpirvBinding> bindings;  ///< by slot
  std::map<uint32_t, uint32_t> constants;     ///< default values of specialisation constants, by id
  uint32_t params_bytes = 0;                  ///< end of the last push constant
  bool size_from_constant = false;            ///< the workgroup size is given by constants
};

/// Reads the interface off the words of a module. Throws std::runtime_error where the module is not of the
/// form that declare_pass.h makes: blocks of one runtime array, 32-bit constants.
SpirvInterface read_interface(std::span<const uint32_t> words);

}  // namespace surefield::testing
