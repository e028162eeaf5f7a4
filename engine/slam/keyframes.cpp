#include "engine/slam/keyframes.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace surefield {

namespace {

constexpr int kGridStep = 16;  // pixels between the samples of a keyframe's depth

}  // namespace

std::vector<Eigen::Vector3f> sample_points(const Frame& frame, const Intrinsics& intrinsics) {
  std::vector<Eigen::Vector3f> points;
  for (int v = kGridStep / 2; v < frame.depth.rows; v += kGridStep)
    for (int u = kGridStep / 2; u < frame.depth.cols; u += kGridStep) {
      const float z = frame.depth.at<float>(v, u);
      if (!(z > 0)) continue;
      points.emplace_back(z * static_cast<float>((u - intrinsics.cx) / intrinsics.fx),
                          z * static_cast<float>((v - intrinsics.cy) / intrinsics.fy), z);
    }
  return points;
}

Keyframe make_keyframe(const Frame& frame, FrameHandle handle, const Camera& camera,
                       std::vector<Eigen::Vector3f> points) {
  Keyframe keyframe{frame.index, frame.timestamp, handle, handle, camera, std::move(points)};
  for (const Eigen::Vector3f& point : keyframe.points) keyframe.middle += point.cast<double>();
  if (!keyframe.points.empty()) keyframe.middle /= static_cast<double>(keyframe.points.size());
  return keyframe;
}

double overlap(const Keyframe& from, const Keyframe& to) {
  const Pose between = to.camera.world_to_camera * from.camera.world_to_camera.inverse();
  const Intrinsics& k = to.camera.intrinsics;
  int seen = 0;
  for (const Eigen::Vector3f& point : from.points) {
    const Eigen::Vector3d p = between * point.cast<double>();
    if (p.z() <= 0) continue;
    const double u = k.fx * p.x() / p.z() + k.cx, v = k.fy * p.y() / p.z() + k.cy;
    seen += u >= 0 && v >= 0 && u <= k.width - 1 && v <= k.height - 1;
  }
  return from.points.empty() ? 0 : static_cast<double>(seen) / static_cast<double>(from.points.size());
}

std::vector<int> nearest_keyframes(const std::vector<Keyframe>& keyframes, int count,
                                   const std::vector<int>& similar) {
  const int newest = static_cast<int>(keyframes.size()) - 1;
  const auto place = [&](int k) {
    return keyframes[k].camera.world_to_camera.inverse().translation().eval();
  };
  const auto middle = [&](int k) {
    return (keyframes[k].camera.world_to_camera.inverse() * keyframes[k].middle).eval();
  };
  const Eigen::Vector3d newest_place = place(newest), newest_middle = middle(newest);
  std::vector<std::pair<double, int>> others;
  for (int k = newest - 1; k >= 0; --k) {
    double apart = (place(k) - newest_place).norm() + (middle(k) - newest_middle).norm();
    if (std::find(similar.begin(), similar.end(), k) != similar.end()) apart = -1;
    if (k == newest - 1) apart = -2;
    others.emplace_back(apart, -k);  // of equals, the more recent first
  }
  const auto kept = std::min<std::size_t>(others.size(), count - 1);
  std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(kept), others.end());
  std::vector<int> nearest{newest};
  for (std::size_t i = 0; i < kept; ++i) nearest.push_back(-others[i].second);
  return nearest;
}

KeyframeWindow select_window(int current, const std::vector<int>& near, int size,
                             const std::function<double(int)>& score) {
  KeyframeWindow window;
  window.members.push_back(current);
  std::vector<std::pair<double, int>> others;
  for (int k : near) {
    if (k == current) continue;
    if (k == current - 1 && size > 1)
      window.members.push_back(k);
    else
      others.emplace_back(score(k), k);
  }
  // Of equals, the more recent first.
  std::sort(others.rbegin(), others.rend());
  for (const auto& [best, k] : others) {
    if (static_cast<int>(window.members.size()) >= size || best <= 0) break;
    window.members.push_back(k);
  }
  std::sort(window.members.begin(), window.members.end());
  window.fixed = window.members.front();
  return window;
}

std::vector<int> mapping_order(const KeyframeWindow& window, std::vector<int> near, int steps, int past,
                               std::mt19937& random) {
  std::sort(near.begin(), near.end());
  std::vector<int> others;
  std::set_difference(near.begin(), near.end(), window.members.begin(), window.members.end(),
                      std::back_inserter(others));
  std::vector<int> order;
  while (static_cast<int>(order.size()) < steps) {
    // The current keyframe leads every cycle.
    order.insert(order.end(), window.members.rbegin(), window.members.rend());
    for (int i = 0; i < past && !others.empty(); ++i)
      order.push_back(others[random() % static_cast<uint32_t>(others.size())]);
  }
  order.resize(steps);
  return order;
}

}  // namespace surefield
