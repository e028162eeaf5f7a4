#include "engine/eval/lens_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr int kLensSteps = 30;               // of Gauss-Newton
constexpr double kLensEnough = 1e-5;         // a smaller step of the lens ends the search
constexpr std::size_t kFewestLensPairs = 5;  // from which anything is concluded
constexpr double kMostStep = 0.15;           // of the lens, at once
constexpr double kPixelFloor = 0.2;          // pixels; no residual is believed to be smaller
constexpr double kDepthFloor = 0.002;        // relative

using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Jacobian = Eigen::Matrix<double, 3, 8>;

struct Lens {
  double focal = 0;
  double aspect = 0;
};

/// How far points are off: median-based standard deviations, pixels and relative depth.
struct Spread {
  double pixels = 2;
  double depth = 0.03;
};

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

class LensFitter {
 public:
  LensFitter(const std::vector<MatchedFrames>& pairs, const Intrinsics& k) : pairs_(pairs), k_(k) {
    motions_.resize(pairs.size(), Eigen::Isometry3d::Identity());
  }

  LensFit run() {
    LensFit fit;
    fit.pairs = static_cast<int>(pairs_.size());
    if (pairs_.size() < kFewestLensPairs) return fit;
    for (std::size_t p = 0; p < pairs_.size(); ++p) begin(p);
    measure();
    for (int step = 0; step < kLensSteps; ++step) {
      const double moved = improve();
      measure();
      if (moved < kLensEnough && step > 5) break;
    }
    judge(fit);
    return fit;
  }

 private:
  double fx() const { return k_.fx * std::exp(lens_.focal + lens_.aspect); }
  double fy() const { return k_.fy * std::exp(lens_.focal - lens_.aspect); }

  Eigen::Vector3d ray(const Eigen::Vector2d& at) const {
    return {(at.x() - k_.cx) / fx(), (at.y() - k_.cy) / fy(), 1};
  }

  /// The motion that takes most points of a pair near where they are seen, by points in space.
  void begin(std::size_t p) {
    const auto& points = pairs_[p].points;
    Eigen::Matrix3Xd from(3, points.size()), to(3, points.size());
    std::vector<double> weights(points.size(), 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      from.col(static_cast<Eigen::Index>(i)) = points[i].from_depth * ray(points[i].from);
      to.col(static_cast<Eigen::Index>(i)) = points[i].to_depth * ray(points[i].to);
    }
    for (int round = 0; round < 15; ++round) {
      double sum = 0;
      Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
      for (std::size_t i = 0; i < points.size(); ++i) {
        sum += weights[i];
        a += weights[i] * from.col(static_cast<Eigen::Index>(i));
        b += weights[i] * to.col(static_cast<Eigen::Index>(i));
      }
      a /= sum;
      b /= sum;
      Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        h += weights[i] * (to.col(c) - b) * (from.col(c) - a).transpose();
      }
      const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
      Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
      motions_[p].linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
      motions_[p].translation() = b - motions_[p].linear() * a;
      std::vector<double> off(points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        off[i] = (motions_[p] * from.col(c) - to.col(c)).norm() / points[i].to_depth;
      }
      const double scale = std::max(1e-4, 1.5 * median(off));
      for (std::size_t i = 0; i < points.size(); ++i)
        weights[i] = 1 / (1 + off[i] * off[i] / (scale * scale));
    }
  }

  /// Pixels in x and y, relative depth.
  Eigen::Vector3d residual(const PointMatch& m, const Eigen::Vector3d& x) const {
    return {fx() * x.x() / x.z() + k_.cx - m.to.x(), fy() * x.y() / x.z() + k_.cy - m.to.y(),
            (x.z() - m.to_depth) / m.to_depth};
  }

  /// By the turn and the shift of the pair's motion, then the lens.
  Jacobian jacobian(std::size_t p, const PointMatch& m, const Eigen::Vector3d& x) const {
    Eigen::Matrix3d by_point;
    by_point << fx() / x.z(), 0, -fx() * x.x() / (x.z() * x.z()), 0, fy() / x.z(),
        -fy() * x.y() / (x.z() * x.z()), 0, 0, 1 / m.to_depth;
    Jacobian j;
    j.leftCols<3>() = -by_point * cross(motions_[p].linear() * (m.from_depth * ray(m.from)));
    j.middleCols<3>(3) = by_point;
    const Eigen::Vector3d r = ray(m.from);
    const Eigen::Matrix3d turn = motions_[p].linear();
    const Eigen::Vector3d by_fx = turn * Eigen::Vector3d(-m.from_depth * r.x(), 0, 0),
                          by_fy = turn * Eigen::Vector3d(0, -m.from_depth * r.y(), 0);
    const Eigen::Vector3d seen(fx() * x.x() / x.z(), fy() * x.y() / x.z(), 0);
    const Eigen::Vector3d log_fx = by_point * by_fx + Eigen::Vector3d(seen.x(), 0, 0),
                          log_fy = by_point * by_fy + Eigen::Vector3d(0, seen.y(), 0);
    j.col(6) = log_fx + log_fy;
    j.col(7) = log_fx - log_fy;
    return j;
  }

  Eigen::Vector3d moved(std::size_t p, const PointMatch& m) const {
    return motions_[p] * (m.from_depth * ray(m.from));
  }

  /// The normal equations of one pair, robust: points that are far off count little.
  void gather(std::size_t p, Matrix8& h, Vector8& b) const {
    h.setZero();
    b.setZero();
    const Eigen::Vector3d scale(1 / spread_.pixels, 1 / spread_.pixels, 1 / spread_.depth);
    for (const PointMatch& m : pairs_[p].points) {
      const Eigen::Vector3d x = moved(p, m);
      if (!(x.z() > 0)) continue;
      const Eigen::Vector3d r = scale.cwiseProduct(residual(m, x));
      const Jacobian j = scale.asDiagonal() * jacobian(p, m, x);
      const double in_image = 1 / (1 + r.head<2>().squaredNorm() / 4), in_depth = 1 / (1 + r.z() * r.z() / 4);
      const Eigen::Vector3d w(in_image * in_depth, in_image * in_depth, in_depth * in_image);
      h += j.transpose() * w.asDiagonal() * j;
      b += j.transpose() * (w.cwiseProduct(r));
    }
    h.topLeftCorner<6, 6>().diagonal() *= 1 + 1e-6;
  }

  /// What a pair says about the lens when its motion follows: gradient and curvature.
  struct Reduced {
    Eigen::Matrix2d h;
    Eigen::Vector2d b;
  };
  Reduced reduce(const Matrix8& h, const Vector8& b) const {
    const Eigen::Matrix<double, 6, 6> own = h.topLeftCorner<6, 6>();
    const Eigen::Matrix<double, 6, 2> mixed = h.topRightCorner<6, 2>();
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(own);
    return {h.bottomRightCorner<2, 2>() - mixed.transpose() * solver.solve(mixed),
            b.tail<2>() - mixed.transpose() * solver.solve(b.head<6>())};
  }

  /// One step of all; returns how far the lens changed.
  double improve() {
    std::vector<Matrix8> hs(pairs_.size());
    std::vector<Vector8> bs(pairs_.size());
    Eigen::Matrix2d h = 1e-9 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      gather(p, hs[p], bs[p]);
      const Reduced reduced = reduce(hs[p], bs[p]);
      h += reduced.h;
      b += reduced.b;
    }
    Eigen::Vector2d step = -h.ldlt().solve(b);
    step = step.cwiseMax(-kMostStep).cwiseMin(kMostStep);
    lens_.focal += step.x();
    lens_.aspect += step.y();
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const Eigen::Matrix<double, 6, 1> own =
          -hs[p].topLeftCorner<6, 6>().ldlt().solve(bs[p].head<6>() + hs[p].topRightCorner<6, 2>() * step);
      const double angle = own.head<3>().norm();
      if (angle > 0) {
        motions_[p].linear() =
            Eigen::AngleAxisd(angle, own.head<3>() / angle).toRotationMatrix() * motions_[p].linear();
      }
      motions_[p].translation() += own.tail<3>();
    }
    return step.cwiseAbs().maxCoeff();
  }

  void measure() {
    std::vector<double> pixels, depths;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      for (const PointMatch& m : pairs_[p].points) {
        const Eigen::Vector3d r = residual(m, moved(p, m));
        pixels.push_back(r.head<2>().norm());
        depths.push_back(std::abs(r.z()));
      }
    }
    spread_ = {std::max(kPixelFloor, median(pixels) / 1.18), std::max(kDepthFloor, 1.48 * median(depths))};
  }

  /// Errors by how much what single pairs say differs: the sandwich estimate, by pairs.
  void judge(LensFit& fit) const {
    Eigen::Matrix2d h = Eigen::Matrix2d::Zero(), scatter = h;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      Matrix8 whole;
      Vector8 gradient;
      gather(p, whole, gradient);
      const Reduced reduced = reduce(whole, gradient);
      h += reduced.h;
      scatter += reduced.b * reduced.b.transpose();
      const Eigen::Matrix3d turn = motions_[p].linear();
      fit.turn = std::max(fit.turn, std::acos(std::clamp(turn(2, 2), -1.0, 1.0)));
    }
    const auto n = static_cast<double>(pairs_.size());
    const Eigen::Matrix2d inverse = h.inverse();
    const Eigen::Matrix2d covariance = n / (n - 2) * inverse * scatter * inverse;
    fit.pixels = spread_.pixels * 1.18;
    fit.focal = {lens_.focal, std::sqrt(std::max(covariance(0, 0), inverse(0, 0)))};
    fit.aspect = {lens_.aspect, std::sqrt(std::max(covariance(1, 1), inverse(1, 1)))};
  }

  const std::vector<MatchedFrames>& pairs_;
  const Intrinsics k_;
  std::vector<Eigen::Isometry3d> motions_;
  Lens lens_;
  Spread spread_;
};

}  // namespace

LensFit fit_lens(const std::vector<MatchedFrames>& pairs, const Intrinsics& intrinsics) {
  return LensFitter(pairs, intrinsics).run();
}

}  // namespace surefield
