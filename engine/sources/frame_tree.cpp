#include "engine/sources/frame_tree.h"

namespace surefield {

namespace {

constexpr std::size_t kDeepest = 100;  // a damaged log may have frames that hang on each other in a circle
constexpr double kRest = 1e-6;         // metres and radians that a link at rest may differ by

}  // namespace

std::string plain_frame(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

void FrameTree::add(const TransformMessage& transform) {
  if (!transform.child_to_parent.matrix().allFinite() || transform.child.empty()) return;
  const std::string parent = plain_frame(transform.header.frame);
  const auto [known, fresh] =
      links_.try_emplace(plain_frame(transform.child), Link{parent, transform.child_to_parent, false});
  if (fresh) return;
  Link& link = known->second;
  link.moves |= link.parent != parent || !link.to_parent.isApprox(transform.child_to_parent, kRest);
}

std::map<std::string, Eigen::Isometry3d> FrameTree::ancestors(const std::string& frame) const {
  std::map<std::string, Eigen::Isometry3d> found;
  std::string at = plain_frame(frame);
  Eigen::Isometry3d to_here = Eigen::Isometry3d::Identity();
  while (found.size() < kDeepest && found.emplace(at, to_here).second) {
    const auto link = links_.find(at);
    if (link == links_.end() || link->second.moves) break;
    to_here = link->second.to_parent * to_here;
    at = link->second.parent;
  }
  return found;
}

std::optional<Eigen::Isometry3d> FrameTree::between(const std::string& from, const std::string& to) const {
  if (from.empty() || to.empty()) return std::nullopt;
  const auto above_to = ancestors(to);
  for (const auto& [frame, from_to_frame] : ancestors(from)) {
    const auto shared = above_to.find(frame);
    // Any frame above both will do: all ways between two frames are the same transform.
    if (shared != above_to.end()) return shared->second.inverse() * from_to_frame;
  }
  return std::nullopt;
}

std::vector<std::string> FrameTree::moving_above(const std::string& frame) const {
  std::vector<std::string> moving;
  std::string at = plain_frame(frame);
  for (std::size_t depth = 0; depth < kDeepest; ++depth) {
    const auto link = links_.find(at);
    if (link == links_.end()) break;
    if (link->second.moves) moving.push_back(at);
    at = link->second.parent;
  }
  return moving;
}

std::string FrameTree::parent(const std::string& frame) const {
  const auto link = links_.find(plain_frame(frame));
  return link == links_.end() ? std::string() : link->second.parent;
}

}  // namespace surefield
