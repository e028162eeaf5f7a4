#include "engine/graph/agreeing_loops.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "engine/graph/twist.h"

namespace surefield {

namespace {

constexpr int kHops = 2;              // believed edges from a loop's end to that of another
constexpr double kRareChi2 = 16.8;    // six numbers exceed it in 1 of 100 cases
constexpr double kUnmeasured = 1e-9;  // of the information's trace, for directions without any

/// A motion to a vertex and the covariance of a small motion after it.
struct UncertainMotion {
  int to = 0;
  Pose motion = Pose::Identity();
  Matrix6 covariance = Matrix6::Zero();
};

UncertainMotion along(const RelativePose& edge) {
  const Matrix6& information = edge.information;
  const Matrix6 floor = std::max(kUnmeasured * information.trace(), 1e-100) * Matrix6::Identity();
  return {edge.to, edge.pose, (information + floor).ldlt().solve(Matrix6::Identity())};
}

UncertainMotion against(const RelativePose& edge) {
  const UncertainMotion forth = along(edge);
  const Pose back = edge.pose.inverse();
  const Matrix6 turned = adjoint(back);
  return {edge.from, back, turned * forth.covariance * turned.transpose()};
}

UncertainMotion chained(const UncertainMotion& first, const UncertainMotion& second) {
  const Matrix6 turned = adjoint(second.motion);
  return {second.to, second.motion * first.motion,
          second.covariance + turned * first.covariance * turned.transpose()};
}

bool agree(const UncertainMotion& a, const UncertainMotion& b) {
  const Vector6 apart = motion_between(a.motion, b.motion);
  return apart.dot((a.covariance + b.covariance).ldlt().solve(apart)) <= kRareChi2;
}

class Agreement {
 public:
  Agreement(const std::vector<RelativePose>& believed, const std::vector<RelativePose>& loops, int vertices)
      : loops_(loops), believed_at_(vertices), loops_at_(vertices) {
    for (const RelativePose& edge : believed) {
      believed_at_[edge.from].push_back(along(edge));
      believed_at_[edge.to].push_back(against(edge));
    }
    for (int l = 0; l < static_cast<int>(loops.size()); ++l) {
      loops_at_[loops[l].from].push_back({l, along(loops[l])});
      loops_at_[loops[l].to].push_back({l, against(loops[l])});
    }
  }

  bool is_confirmed(int loop) const {
    const UncertainMotion forth = along(loops_[loop]);
    const std::vector<UncertainMotion> ends = near(forth.to);
    for (const UncertainMotion& beside : near(loops_[loop].from))
      for (const Step& other : loops_at_[beside.to])
        for (const UncertainMotion& end : ends)
          if (other.loop != loop && end.to == other.motion.to &&
              agree(chained(forth, end), chained(beside, other.motion)))
            return true;
    return false;
  }

 private:
  struct Step {
    int loop;
    UncertainMotion motion;
  };

  /// The vertex itself and those few believed edges away, each once.
  std::vector<UncertainMotion> near(int vertex) const {
    std::vector<UncertainMotion> found(1);
    found[0].to = vertex;
    std::size_t begin = 0;
    for (int hop = 0; hop < kHops; ++hop) {
      const std::size_t end = found.size();
      for (; begin < end; ++begin)
        for (const UncertainMotion& step : believed_at_[found[begin].to]) {
          const auto is_there = [&](const UncertainMotion& other) { return other.to == step.to; };
          if (std::none_of(found.begin(), found.end(), is_there))
            found.push_back(chained(found[begin], step));
        }
    }
    return found;
  }

  const std::vector<RelativePose>& loops_;
  std::vector<std::vector<UncertainMotion>> believed_at_;  ///< the edges that begin at each vertex
  std::vector<std::vector<Step>> loops_at_;
};

}  // namespace

std::vector<bool> agreeing_loops(const std::vector<RelativePose>& believed,
                                 const std::vector<RelativePose>& loops, int vertices) {
  const Agreement agreement(believed, loops, vertices);
  std::vector<bool> confirmed(loops.size());
  for (std::size_t l = 0; l < loops.size(); ++l) confirmed[l] = agreement.is_confirmed(static_cast<int>(l));
  return confirmed;
}

}  // namespace surefield
