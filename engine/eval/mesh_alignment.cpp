#include "engine/eval/mesh_alignment.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>

#include "engine/types/error.h"

namespace surefield {

namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kIterations = 30;
constexpr double kReach = 0.10;       // metres
constexpr double kKept = 0.9;         // of the points within reach
constexpr double kSettled = 1e-7;     // metres and radians
constexpr double kDetermined = 1e-4;  // of the largest eigenvalue; a direction of less is left alone
constexpr std::size_t kFewestMatches = 10;

/// A point and the plane of the surface next to it.
struct Match {
  Vector3d point;
  Vector3d normal;
  double residual = 0;  ///< from the plane, metres
  double distance = 0;  ///< from the surface, metres
};

std::vector<Match> find_matches(const std::vector<Vector3d>& points, const TriangleTree& surface,
                                const Eigen::Isometry3d& pose) {
  std::vector<Match> matches;
  for (const Vector3d& point : points) {
    const Vector3d moved = pose * point;
    const SurfacePoint nearest = surface.nearest(moved);
    if (nearest.distance > kReach) continue;
    const Vector3d normal = surface.normal(nearest.triangle);
    matches.push_back({moved, normal, normal.dot(moved - nearest.position), nearest.distance});
  }
  const auto kept = static_cast<std::ptrdiff_t>(kKept * static_cast<double>(matches.size()));
  std::nth_element(matches.begin(), matches.begin() + kept, matches.end(),
                   [](const Match& a, const Match& b) { return a.distance < b.distance; });
  matches.resize(static_cast<std::size_t>(kept));
  return matches;
}

Vector3d centre_of(const std::vector<Match>& matches) {
  Vector3d sum = Vector3d::Zero();
  for (const Match& match : matches) sum += match.point;
  return sum / static_cast<double>(matches.size());
}

/// The rotation (about `centre`) and translation that make the residuals smallest, to first order.
Vector6d solve_step(const std::vector<Match>& matches, const Vector3d& centre) {
  Matrix6d normal_matrix = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  for (const Match& match : matches) {
    Vector6d row;
    row << (match.point - centre).cross(match.normal), match.normal;
    normal_matrix += row * row.transpose();
    right -= row * match.residual;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(normal_matrix);
  Vector6d step = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (value <= kDetermined * eigen.eigenvalues()[5]) continue;
    step += eigen.eigenvectors().col(i) * (eigen.eigenvectors().col(i).dot(right) / value);
  }
  return step;
}

Eigen::Isometry3d motion_of(const Vector6d& step, const Vector3d& centre) {
  const Vector3d rotation = step.head<3>();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(centre + step.tail<3>());
  if (rotation.norm() > 0) motion.rotate(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  return motion.translate(-centre);
}

}  // namespace

Eigen::Isometry3d align_poses(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) {
    throw InputError("no pose can be paired with the ground truth; do the time stamps match?");
  }
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  Vector3d estimates = Vector3d::Zero();
  Vector3d truths = Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    rotations += pair.truth.linear() * pair.estimate.linear().transpose();
    estimates += pair.estimate.translation();
    truths += pair.truth.translation();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotations, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double side = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  Eigen::Isometry3d alignment = Eigen::Isometry3d::Identity();
  alignment.linear() = svd.matrixU() * Vector3d(1, 1, side).asDiagonal() * svd.matrixV().transpose();
  alignment.translation() = (truths - alignment.linear() * estimates) / static_cast<double>(pairs.size());
  return alignment;
}

Eigen::Isometry3d align_to_surface(const std::vector<Vector3d>& points, const TriangleTree& surface,
                                   const Eigen::Isometry3d& start) {
  Eigen::Isometry3d pose = start;
  for (int i = 0; i < kIterations; ++i) {
    const std::vector<Match> matches = find_matches(points, surface, pose);
    if (matches.size() < kFewestMatches) return start;
    const Vector3d centre = centre_of(matches);
    const Vector6d step = solve_step(matches, centre);
    pose = motion_of(step, centre) * pose;
    if (step.cwiseAbs().maxCoeff() < kSettled) break;
  }
  return pose;
}

}  // namespace surefield
