#pragma once

#include <memory>
#include <string>

#include "engine/sources/frame_source.h"

namespace surefield {

/// A camera that OpenNI2 knows: the first one, or that of a URI as OpenNI2 has them, or a recording (.oni).
/// The newest frame wins. Intrinsics are those that the device's fields of view give, with the centre in the
/// middle. A device that is pulled out ends the source. Throws InputError where there is none, or the build
/// has no OpenNI2.
std::unique_ptr<FrameSource> open_openni(const std::string& uri);

}  // namespace surefield
