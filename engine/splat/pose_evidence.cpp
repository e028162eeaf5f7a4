#include "engine/splat/pose_evidence.h"

#include <Eigen/Cholesky>

#include "shaders/shared/align_types.h"

namespace surefield {

namespace {

using Vector = Eigen::Matrix<double, 6, 1>;

PoseEvidence::Matrix normal_of(const glsl::AlignSums& sums) {
  PoseEvidence::Matrix normal;
  int at = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      normal(row, column) = normal(column, row) = static_cast<double>(sums.normal[at++]);
  return normal;
}

Vector slope_of(const glsl::AlignSums& sums) {
  Vector slope;
  for (int row = 0; row < 6; ++row) slope[row] = static_cast<double>(sums.slope[row]);
  return slope;
}

}  // namespace

PoseEvidence evidence_of(std::span<const glsl::AlignSums> parts, double weight) {
  PoseEvidence evidence;
  Vector slope = Vector::Zero();
  for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
    evidence.information += weight * normal_of(parts[i]);
    slope += weight * slope_of(parts[i]);
  }
  const Vector step = -evidence.information.ldlt().solve(slope);
  if (!step.allFinite()) return evidence;
  const auto add = [&](const PoseEvidence::Matrix& normal, const Vector& part) {
    const Vector left = weight * (part + normal * step);
    evidence.disagreement += left * left.transpose();
  };
  for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
    const PoseEvidence::Matrix all = normal_of(parts[i]), colour = normal_of(parts[i + 1]);
    const Vector both = slope_of(parts[i]), light = slope_of(parts[i + 1]);
    add(colour, light);
    add(all - colour, both - light);
  }
  return evidence;
}

}  // namespace surefield
