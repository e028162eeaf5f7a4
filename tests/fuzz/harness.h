#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace surefield::fuzz {

/// A folder of this process in memory, where there is such a place, that goes away with it.
const std::filesystem::path& folder();

/// Writes an input where a reader can open it by this name.
std::filesystem::path write_input(const std::string& name, const uint8_t* data, std::size_t size);

/// Does `read` and takes every Error as an answer; any other exception, and a message of more than one line,
/// is a fault and ends the program.
template <typename Read>
void expect_answer(Read read);

}  // namespace surefield::fuzz

#include "engine/types/error.h"

namespace surefield::fuzz {

template <typename Read>
void expect_answer(Read read) {
  try {
    read();
  } catch (const Error& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) __builtin_trap();
  }
}

}  // namespace surefield::fuzz

/// A harness over a reader of files: `read` is a function of the path of the input, which is named `name`.
#define SUREFIELD_FUZZ_FILE(name, read)                                          \
  extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) { \
    const auto file = surefield::fuzz::write_input(name, data, size);            \
    surefield::fuzz::expect_answer([&] { read(file); });                         \
    return 0;                                                                    \
  }
