// Lists of pairs.
#include "tests/fuzz/dataset_harness.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using namespace surefield::fuzz;
  prepare("own", "camera.yaml", kCameraText);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  surefield::fuzz::open_with("own", "associations.txt", data, size);
  return 0;
}
