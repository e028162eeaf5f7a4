#pragma once

namespace surefield {

/// Which terms the gradient of a pose has: every one, or those through the projected centre and the depth
/// alone (docs/method.md, "Backward").
enum class PoseGradientKind { Full, Light };

}  // namespace surefield
