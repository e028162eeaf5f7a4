// In the place of lpips.cpp where the library is built without networks.
#include "engine/eval/lpips.h"
#include "engine/types/error.h"

namespace surefield {

struct Lpips::Network {};

Lpips::Lpips(const std::filesystem::path& network) {
  throw InputError(network, "this build uses no networks; build with -DSUREFIELD_NETWORKS=ON");
}

Lpips::~Lpips() = default;

double Lpips::distance(const cv::Mat&, const cv::Mat&) {
  return 0;
}

}  // namespace surefield
