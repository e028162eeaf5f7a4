#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/logs/messages.h"

namespace surefield {

/// The frames of a robot as tf describes them: each hangs on one parent.
class FrameTree {
 public:
  /// Takes note of a transform; one that comes again and is another makes its frame one that moves.
  void add(const TransformMessage& transform);

  /// From one frame to another, where only links that do not move lie between; nullopt where there is no such
  /// way.
  std::optional<Eigen::Isometry3d> between(const std::string& from, const std::string& to) const;

  /// The frames from this one up to the root whose link to their parent moves, the nearest first.
  std::vector<std::string> moving_above(const std::string& frame) const;

  /// The parent of a frame; empty where it has none.
  std::string parent(const std::string& frame) const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d to_parent = Eigen::Isometry3d::Identity();
    bool moves = false;
  };
  /// The frames above this one that are reached by links that do not move, itself included, and the
  /// transforms to them.
  std::map<std::string, Eigen::Isometry3d> ancestors(const std::string& frame) const;

  std::map<std::string, Link> links_;  ///< by the child
};

/// The name of a frame without the slash that it begins with in older logs.
std::string plain_frame(const std::string& frame);

}  // namespace surefield
