// The stamps of plain recordings.
#include "tests/fuzz/dataset_harness.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using namespace surefield::fuzz;
  prepare("own", "camera.yaml", kCameraText);
  prepare("own", "rgb/1.png", "");
  prepare("own", "depth/1.png", "");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  surefield::fuzz::open_with("own", "timestamps.txt", data, size);
  return 0;
}
