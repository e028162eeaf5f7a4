// Replica's true poses.
#include "tests/fuzz/dataset_harness.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using namespace surefield::fuzz;
  prepare("room0", "results/frame000000.jpg", "");
  prepare("room0", "cam_params.json",
          R"({"camera": {"w": 12, "h": 8, "fx": 10, "fy": 11, "cx": 5.5, "cy": 3.5, "scale": 1000}})");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  surefield::fuzz::open_with("room0", "traj.txt", data, size);
  return 0;
}
