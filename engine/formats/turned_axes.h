#pragma once

#include <array>

namespace surefield {

/// The axes of SPZ and glTF files point right, up and back; ours, like those of PLY files, right, down and
/// front. Going from one to the other, in either direction, is a turn by 180 degrees about x. These are the
/// signs of x, y and z, of positions as of quaternions.
constexpr std::array<float, 3> kTurnedAxes = {1, -1, -1};

/// The signs of the SH coefficients of degree 1 to 3 in that turn: those of the basis polynomials.
constexpr std::array<float, 15> kTurnedHarmonics = {-1, -1, 1, -1, 1, 1, -1, 1, -1, 1, -1, -1, 1, -1, 1};

}  // namespace surefield
