#pragma once

#include <cstddef>
#include <vector>

#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// Whether Gaussian `i` can be drawn: all its values are finite and its rotation is not zero.
bool is_finite(const GaussianCloud& cloud, std::size_t i);

/// The Gaussians for which is_finite() holds, by their index.
std::vector<std::size_t> finite_gaussians(const GaussianCloud& cloud);

/// Sorts Gaussians, given by index, along a Morton curve through their box: those that follow one another in
/// it lie close together. All named ones must be finite.
void sort_along_morton_curve(const GaussianCloud& cloud, std::vector<std::size_t>& gaussians);

/// The Gaussians with these indices, in this order.
GaussianCloud select(const GaussianCloud& cloud, const std::vector<std::size_t>& gaussians);

}  // namespace surefield
