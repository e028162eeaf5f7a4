// Replica's calibration.
#include "tests/fuzz/dataset_harness.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using namespace surefield::fuzz;
  prepare("room0", "results/frame000000.jpg", "");
  prepare("room0", "results/depth000000.png", "");
  prepare("room0", "traj.txt", "1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1\n");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  surefield::fuzz::open_with("room0", "cam_params.json", data, size);
  return 0;
}
