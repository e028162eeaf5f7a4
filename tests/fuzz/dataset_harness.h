#pragma once

#include "engine/sources/open_dataset.h"
#include "tests/fuzz/harness.h"

namespace surefield::fuzz {

/// Opens a dataset of which the input is one file, and the others are as they should be; reads its first
/// frame.
inline void open_with(const std::string& dataset, const std::string& name, const uint8_t* data,
                      std::size_t size) {
  write_input(dataset + "/" + name, data, size);
  expect_answer([&] {
    const Dataset opened = open_dataset(folder() / dataset);
    if (opened.recording->count() > 0) opened.recording->load(0);
  });
}

/// Writes a text file of the dataset, once.
inline void prepare(const std::string& dataset, const std::string& name, const std::string& text) {
  write_input(dataset + "/" + name, reinterpret_cast<const uint8_t*>(text.data()), text.size());
}

inline constexpr const char* kCameraText =
    "width: 4\nheight: 3\nfx: 4\nfy: 4\ncx: 2\ncy: 1\ndepth_unit: 0.001\n";

}  // namespace surefield::fuzz
