#pragma once

#include <string>

namespace surefield {

/// A number with so many decimals; "-" where there is none (NaN or infinity).
std::string shown(double value, int decimals);

}  // namespace surefield
