#pragma once

namespace surefield {

/// The depth of a Gaussian over its footprint: that of its centre (as in the paper), or that of a plane
/// through the centre (docs/method.md, "Forward").
enum class DepthModel { Centre, Plane };

}  // namespace surefield
