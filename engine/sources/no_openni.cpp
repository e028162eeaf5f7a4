// In the place of openni_source.cpp where OpenNI2 was not found when Surefield was built.
#include "engine/sources/openni_source.h"
#include "engine/types/error.h"

namespace surefield {

std::unique_ptr<FrameSource> open_openni(const std::string&) {
  throw InputError(
      "openni2: this build has no OpenNI2; install libopenni2-dev and build anew, or send frames as a stream "
      "(docs/live.md)");
}

}  // namespace surefield
