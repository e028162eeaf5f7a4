// In the place of netvlad.cpp where the library is built without networks.
#include "engine/places/netvlad.h"
#include "engine/types/error.h"

namespace surefield {

struct NetVladDescriptor::Network {};

NetVladDescriptor::NetVladDescriptor(const std::filesystem::path& network) {
  throw InputError(network,
                   "this build uses no networks; build with -DSUREFIELD_NETWORKS=ON, or choose vlad");
}

NetVladDescriptor::~NetVladDescriptor() = default;

Eigen::VectorXf NetVladDescriptor::describe(const cv::Mat&) {
  return {};
}

}  // namespace surefield
