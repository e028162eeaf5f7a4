// The lists of TUM's layout.
#include "tests/fuzz/dataset_harness.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using namespace surefield::fuzz;
  prepare("own", "camera.yaml", kCameraText);
  prepare("own", "depth.txt", "1.0 depth/1.png\n2.0 depth/2.png\n");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  surefield::fuzz::open_with("own", "rgb.txt", data, size);
  return 0;
}
