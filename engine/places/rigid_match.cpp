#include "engine/places/rigid_match.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace surefield {

namespace {

constexpr float kDistinct = 0.8f;  // distance to the nearest, over that to the second
constexpr float kSmooth = 1.06f;   // depths about a feature differ by less than this factor
constexpr int kSamples = 500;      // of three matches
constexpr float kLeastApart =
    0.1f;  // metres between the points of a sample, else it says little of the rotation
constexpr double kLeastError = 0.02;  // metres
constexpr double kDeviations = 3;
constexpr int kRefits = 3;

/// The depth at a pixel where the surface about it is smooth; 0 elsewhere.
float smooth_depth(const cv::Mat& depth, const Eigen::Vector2f& pixel) {
  const int x = cvRound(pixel.x()), y = cvRound(pixel.y());
  if (x < 1 || y < 1 || x + 1 >= depth.cols || y + 1 >= depth.rows) return 0;
  const float middle = depth.at<float>(y, x);
  float nearest = middle, farthest = middle;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const float z = depth.at<float>(v, u);
      if (!(z > 0)) return 0;
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
    }
  return farthest < kSmooth * nearest ? middle : 0;
}

/// The nearest row and whether it is clearly nearer than all others; rows of unit length.
std::pair<int, bool> nearest(const Eigen::VectorXf& products) {
  Eigen::Index best = 0;
  const float most = products.maxCoeff(&best);
  float second = -1;
  for (Eigen::Index i = 0; i < products.size(); ++i)
    if (i != best) second = std::max(second, products[i]);
  const auto distance = [](float product) { return std::sqrt(std::max(0.0f, 2 - 2 * product)); };
  return {static_cast<int>(best), distance(most) < kDistinct * distance(second)};
}

using Matches = std::vector<std::pair<int, int>>;

/// Features that are each other's nearest, clearly so as seen from the first frame.
Matches mutual_matches(const FeatureBytes& from, const FeatureBytes& to) {
  Matches matches;
  if (from.rows() == 0 || to.rows() < 2) return matches;
  const Eigen::MatrixXf products = to_floats(from) * to_floats(to).transpose();
  for (int i = 0; i < products.rows(); ++i) {
    const auto [j, clear] = nearest(products.row(i).transpose());
    Eigen::Index back = 0;
    products.col(j).maxCoeff(&back);
    if (clear && back == i) matches.emplace_back(i, j);
  }
  return matches;
}

/// Matched points as they are compared.
struct Pairs {
  Eigen::Matrix3Xd from, to;
  Eigen::VectorXd limit;  ///< distance up to which two are laid on each other, metres
};

Pairs pairs_of(const PlacedFeatures& from, const PlacedFeatures& to, const Matches& matches,
               const DepthNoise& noise) {
  const auto count = static_cast<Eigen::Index>(matches.size());
  Pairs pairs{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [a, b] = matches[static_cast<std::size_t>(i)];
    pairs.from.col(i) = from.points[static_cast<std::size_t>(a)].cast<double>();
    pairs.to.col(i) = to.points[static_cast<std::size_t>(b)].cast<double>();
    pairs.limit[i] = std::max(
        kLeastError, kDeviations * std::hypot(noise.sigma(pairs.from(2, i)), noise.sigma(pairs.to(2, i))));
  }
  return pairs;
}

Pose fit(const Pairs& pairs, const std::vector<Eigen::Index>& chosen) {
  return Pose(Eigen::umeyama(pairs.from(Eigen::all, chosen), pairs.to(Eigen::all, chosen), false));
}

std::vector<Eigen::Index> inliers_of(const Pairs& pairs, const Pose& pose) {
  std::vector<Eigen::Index> inliers;
  for (Eigen::Index i = 0; i < pairs.limit.size(); ++i)
    if ((pose * pairs.from.col(i) - pairs.to.col(i)).norm() < pairs.limit[i]) inliers.push_back(i);
  return inliers;
}

/// Whether three matches are those of one triangle that is not too small.
bool is_rigid(const Pairs& pairs, const std::vector<Eigen::Index>& three) {
  for (std::size_t a = 0; a < 3; ++a) {
    const Eigen::Index i = three[a], j = three[(a + 1) % 3];
    const double before = (pairs.from.col(i) - pairs.from.col(j)).norm();
    const double after = (pairs.to.col(i) - pairs.to.col(j)).norm();
    if (before < kLeastApart || std::abs(before - after) > pairs.limit[i] + pairs.limit[j]) return false;
  }
  return true;
}

/// See RigidMatch::spread.
double spread_of(const Pairs& pairs, const std::vector<Eigen::Index>& chosen) {
  Eigen::Matrix2Xd places(2, static_cast<Eigen::Index>(chosen.size()));
  for (Eigen::Index i = 0; i < places.cols(); ++i)
    places.col(i) = pairs.to.col(chosen[static_cast<std::size_t>(i)]).hnormalized();
  places.colwise() -= places.rowwise().mean().eval();
  const Eigen::Matrix2d covariance = places * places.transpose() / static_cast<double>(places.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[0], 0.0));
}

}  // namespace

PlacedFeatures place_features(const Frame& frame, const Intrinsics& intrinsics) {
  const ImageFeatures found = find_features(frame.colour);
  PlacedFeatures placed;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < found.pixels.size(); ++i) {
    const Eigen::Vector2f& pixel = found.pixels[i];
    const float z = smooth_depth(frame.depth, pixel);
    if (!(z > 0)) continue;
    rows.push_back(static_cast<Eigen::Index>(i));
    placed.points.emplace_back(z * (pixel.x() - static_cast<float>(intrinsics.cx)) / intrinsics.fx,
                               z * (pixel.y() - static_cast<float>(intrinsics.cy)) / intrinsics.fy, z);
  }
  placed.descriptors = to_bytes(found.descriptors(rows, Eigen::all));
  return placed;
}

std::optional<RigidMatch> match_rigidly(const PlacedFeatures& from, const PlacedFeatures& to,
                                        const DepthNoise& noise, int fewest) {
  const Matches matches = mutual_matches(from.descriptors, to.descriptors);
  if (static_cast<int>(matches.size()) < std::max(fewest, 3)) return std::nullopt;
  const Pairs pairs = pairs_of(from, to, matches, noise);
  std::mt19937 random(1);
  std::vector<Eigen::Index> best;
  for (int sample = 0; sample < kSamples; ++sample) {
    std::vector<Eigen::Index> three;
    for (int n = 0; n < 3; ++n) three.push_back(static_cast<Eigen::Index>(random() % matches.size()));
    if (!is_rigid(pairs, three)) continue;
    std::vector<Eigen::Index> inliers = inliers_of(pairs, fit(pairs, three));
    if (inliers.size() > best.size()) best = std::move(inliers);
  }
  RigidMatch match{.matches = static_cast<int>(matches.size())};
  for (int n = 0; n < kRefits && best.size() >= 3; ++n) {
    match.from_to = fit(pairs, best);
    best = inliers_of(pairs, match.from_to);
  }
  match.inliers = static_cast<int>(best.size());
  if (match.inliers < std::max(fewest, 3)) return std::nullopt;
  match.spread = spread_of(pairs, best);
  return match;
}

}  // namespace surefield
