#include "engine/slam/keyframes.h"

#include <algorithm>
#include <numeric>

namespace surefield {

namespace {

constexpr int kGridStep = 16;  // pixels between the samples of a keyframe's depth

}  // namespace

std::vector<Eigen::Vector3f> sample_points(const Frame& frame, const Intrinsics& intrinsics,
                                           double depth_max) {
  std::vector<Eigen::Vector3f> points;
  for (int v = kGridStep / 2; v < frame.depth.rows; v += kGridStep)
    for (int u = kGridStep / 2; u < frame.depth.cols; u += kGridStep) {
      const float z = frame.depth.at<float>(v, u);
      if (!(z > 0 && z <= depth_max)) continue;
      points.emplace_back(z * static_cast<float>((u - intrinsics.cx) / intrinsics.fx),
                          z * static_cast<float>((v - intrinsics.cy) / intrinsics.fy), z);
    }
  return points;
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

KeyframeWindow select_window(const std::vector<Keyframe>& keyframes, int size) {
  const int current = static_cast<int>(keyframes.size()) - 1;
  KeyframeWindow window;
  window.members.push_back(current);
  if (current > 0 && size > 1) window.members.push_back(current - 1);

  std::vector<int> others(std::max(0, current - 1));
  std::iota(others.begin(), others.end(), 0);
  std::vector<double> scores;
  for (int other : others) scores.push_back(overlap(keyframes[current], keyframes[other]));
  // Of equals, the more recent first.
  std::stable_sort(others.begin(), others.end(),
                   [&](int a, int b) { return scores[a] != scores[b] ? scores[a] > scores[b] : a > b; });
  for (int other : others) {
    if (static_cast<int>(window.members.size()) >= size || scores[other] <= 0) break;
    window.members.push_back(other);
  }
  std::sort(window.members.begin(), window.members.end());
  window.fixed = window.members.front();
  return window;
}

std::vector<int> mapping_order(const KeyframeWindow& window, int keyframes, int steps, int past,
                               std::mt19937& random) {
  std::vector<int> others;
  for (int k = 0; k < keyframes; ++k)
    if (std::find(window.members.begin(), window.members.end(), k) == window.members.end())
      others.push_back(k);
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
