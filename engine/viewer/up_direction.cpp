#include "engine/viewer/up_direction.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/viewer/view_path.h"

namespace surefield {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kSearched = 3000, kFitted = 30000;  // Gaussians, at most
constexpr float kUnseenLogit = -2;
constexpr double kDisc = 0.5;  // of its second axis, the shortest one of a Gaussian that has a normal
constexpr double kLargestShare = 0.99;    // Gaussians larger than so many others count as these
constexpr double kSearch = 60 * kDegree;  // about what is up in the cameras' images
constexpr double kGrid = 2 * kDegree;
constexpr double kRoll = 15 * kDegree;  // by so much cameras are tilted sideways
constexpr double kUsualPitch = -15 * kDegree, kPitch = 50 * kDegree;  // of where they look, upwards
constexpr double kSpread = 4 * kDegree;  // of the normals of a level or upright surface
constexpr double kHalfThickness[] = {0.08, 0.06, 0.05, 0.04, 0.03, 0.03};  // of a level plane, metres
constexpr double kLevel[] = {20, 15, 12, 10, 10, 10};                      // degrees
constexpr int kPlanes = 6;                                                 // level ones, at most
constexpr double kLeastPlane = 0.15;                                       // of the largest
// What the planes must be for up to be told by them.
constexpr double kLeastShare = 0.02;  // of all surface
constexpr double kThickest = 0.05;    // metres, standard deviation
constexpr double kLeastExtent = 0.1;  // metres, standard deviation

/// A piece of the map's surface.
struct Surfel {
  Eigen::Vector3d centre, normal;
  double area = 0;
};

std::vector<Surfel> surfels_of(const GaussianCloud& map) {
  std::vector<Surfel> surfels;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map.opacity_logits[i] < kUnseenLogit || !map.rotations[i].allFinite() || map.rotations[i].isZero())
      continue;
    const Eigen::Vector3d scales = map.log_scales[i].cast<double>().array().exp();
    int shortest = 0;
    const double least = scales.minCoeff(&shortest), most = scales.maxCoeff();
    const double middle = scales.sum() - least - most;
    if (!(least < kDisc * middle)) continue;
    const Eigen::Vector4d q = map.rotations[i].cast<double>().normalized();
    surfels.push_back({map.means[i].cast<double>(),
                       Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix().col(shortest),
                       middle * most});
  }
  if (surfels.empty()) return surfels;
  std::vector<double> areas;
  for (const Surfel& s : surfels) areas.push_back(s.area);
  const auto at =
      areas.begin() + static_cast<std::ptrdiff_t>(kLargestShare * static_cast<double>(areas.size() - 1));
  std::nth_element(areas.begin(), at, areas.end());
  for (Surfel& s : surfels) s.area = std::min(s.area, *at);
  return surfels;
}

/// Every so many of them, so that there are `most` at most.
std::vector<Surfel> thinned(const std::vector<Surfel>& surfels, std::size_t most) {
  const std::size_t stride = (surfels.size() + most - 1) / most;
  std::vector<Surfel> some;
  for (std::size_t i = 0; i < surfels.size(); i += std::max<std::size_t>(stride, 1))
    some.push_back(surfels[i]);
  return some;
}

double total_area(const std::vector<Surfel>& surfels) {
  double sum = 0;
  for (const Surfel& s : surfels) sum += s.area;
  return sum;
}

/// How much a surface with this cosine between its normal and up is level, and how much upright: 0 to 1.
double level(double cosine) {
  return std::exp(-(1 - cosine * cosine) / (2 * kSpread * kSpread));
}
double upright(double cosine) {
  return std::exp(-cosine * cosine / (2 * kSpread * kSpread));
}

/// Directions about `middle`, closer than kSearch, about kGrid apart.
std::vector<Eigen::Vector3d> directions_about(const Eigen::Vector3d& middle) {
  const Eigen::Vector3d a = middle.unitOrthogonal(), b = middle.cross(a);
  std::vector<Eigen::Vector3d> directions{middle};
  for (double tilt = kGrid; tilt < kSearch; tilt += kGrid) {
    const int around = static_cast<int>(std::ceil(2 * std::numbers::pi * std::sin(tilt) / kGrid));
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      directions.push_back(std::cos(tilt) * middle +
                           std::sin(tilt) * (std::cos(angle) * a + std::sin(angle) * b));
    }
  }
  return directions;
}

/// The smallest eigenvector, in the half space of `up`; the roots of the eigenvalues, smallest first.
Eigen::Vector3d least_axis(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& up,
                           Eigen::Vector3d& spreads) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  spreads = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  const Eigen::Vector3d axis = solver.eigenvectors().col(0);
  return axis.dot(up) < 0 ? Eigen::Vector3d(-axis) : axis;
}

/// How the cameras that saw a map were held: what of them tells up from the other axes of a room, which looks
/// the same along each.
class Holding {
 public:
  explicit Holding(const Trajectory& trajectory) {
    for (const StampedPose& pose : trajectory) {
      if (!pose.is_finite()) continue;
      const Eigen::Vector3d x = pose.camera_to_world.linear().col(0);
      sideways_ += x * x.transpose();
      forward_ += pose.camera_to_world.linear().col(2);
      ++cameras_;
    }
  }

  /// How likely they were held like that if up were this: hardly tilted sideways, and looking down rather
  /// than up.
  double likelihood(const Eigen::Vector3d& up) const {
    if (cameras_ == 0) return 1;
    const double roll = up.dot(sideways_ * up) / cameras_;
    const double pitch = std::asin(std::clamp(up.dot(forward_) / cameras_, -1.0, 1.0)) - kUsualPitch;
    return std::exp(-roll / (2 * std::sin(kRoll) * std::sin(kRoll)) - pitch * pitch / (2 * kPitch * kPitch));
  }

 private:
  Eigen::Matrix3d sideways_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d forward_ = Eigen::Vector3d::Zero();
  int cameras_ = 0;
};

/// The direction along or across which most surface faces, of those that fit how the cameras were held.
Eigen::Vector3d up_by_normals(const std::vector<Surfel>& surfels, const Trajectory& trajectory) {
  const Holding holding(trajectory);
  const std::vector<Surfel> some = thinned(surfels, kSearched);
  Eigen::Vector3d best = up_of(trajectory);
  double most = -1;
  for (const Eigen::Vector3d& up : directions_about(best)) {
    double faces = 0;
    for (const Surfel& s : some) {
      const double cosine = s.normal.dot(up);
      faces += s.area * (level(cosine) + upright(cosine));
    }
    faces *= holding.likelihood(up);
    if (faces > most) {
      most = faces;
      best = up;
    }
  }
  Eigen::Vector3d spreads;
  for (int i = 0; i < 5; ++i) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Surfel& s : surfels) {
      const double cosine = s.normal.dot(best);
      sum += s.area * (upright(cosine) - level(cosine)) * s.normal * s.normal.transpose();
    }
    best = least_axis(sum, best, spreads);
  }
  return best;
}

/// Level planes, by what lies on them: the scatter about their middles, and their area.
struct LevelPlanes {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  double area = 0;
};

/// Those of at most `half` thickness to both sides that hold the most surface, the largest first.
LevelPlanes level_planes(const std::vector<Surfel>& surfels, const Eigen::Vector3d& up, double half,
                         double tilt) {
  struct Height {
    double height;
    const Surfel* surfel;
  };
  std::vector<Height> left;
  for (const Surfel& s : surfels)
    if (std::abs(s.normal.dot(up)) > std::cos(tilt * kDegree)) left.push_back({s.centre.dot(up), &s});
  std::sort(left.begin(), left.end(), [](const Height& a, const Height& b) { return a.height < b.height; });
  LevelPlanes planes;
  double largest = 0;
  for (int plane = 0; plane < kPlanes && !left.empty(); ++plane) {
    // The window of 2 * half that holds the most.
    double area = 0, most = 0;
    std::size_t begin = 0, from = 0, to = 0;
    for (std::size_t end = 0; end < left.size(); ++end) {
      area += left[end].surfel->area;
      while (left[end].height - left[begin].height > 2 * half) area -= left[begin++].surfel->area;
      if (area > most) {
        most = area;
        from = begin;
        to = end + 1;
      }
    }
    largest = std::max(largest, most);
    if (most < kLeastPlane * largest) break;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t i = from; i < to; ++i) middle += left[i].surfel->area / most * left[i].surfel->centre;
    for (std::size_t i = from; i < to; ++i) {
      const Eigen::Vector3d off = left[i].surfel->centre - middle;
      planes.scatter += left[i].surfel->area * off * off.transpose();
    }
    planes.area += most;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(from),
               left.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return planes;
}

}  // namespace

UpDirection find_up(const GaussianCloud& map, const Trajectory& trajectory) {
  const UpDirection held{up_of(trajectory), false};
  const std::vector<Surfel> surfels = thinned(surfels_of(map), kFitted);
  if (surfels.empty()) return held;
  Eigen::Vector3d up = up_by_normals(surfels, trajectory), spreads = Eigen::Vector3d::Zero();
  double share = 0;
  for (std::size_t i = 0; i < std::size(kLevel); ++i) {
    const LevelPlanes planes = level_planes(surfels, up, kHalfThickness[i], kLevel[i]);
    if (!(planes.area > 0)) return held;
    up = least_axis(planes.scatter / planes.area, up, spreads);
    share = planes.area / total_area(surfels);
  }
  const bool told = share > kLeastShare && spreads[0] < kThickest && spreads[1] > kLeastExtent &&
                    up.dot(held.up) > std::cos(kSearch);
  return told ? UpDirection{up, true} : held;
}

}  // namespace surefield
