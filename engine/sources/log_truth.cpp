#include "engine/sources/log_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "engine/types/error.h"

namespace surefield {

namespace {

using ReadPose = TransformMessage (*)(const SerialisedMessage&);

struct PoseType {
  const char* type;
  ReadPose read;
  int score;  ///< of topics that nothing else tells apart
};

constexpr std::array<PoseType, 4> kPoseTypes = {
    {{"geometry_msgs/PoseStamped", read_pose, 3},
     {"geometry_msgs/TransformStamped", read_stamped_transform, 3},
     {"nav_msgs/Odometry", read_odometry, 2},
     {"geometry_msgs/PoseWithCovarianceStamped", read_pose, 1}}};
constexpr uint64_t kFewestPoses = 2;
constexpr int kNamedForTruth = 10;

bool is_named_for_truth(const std::string& name) {
  for (const char* part :
       {"ground_truth", "groundtruth", "/gt", "mocap", "vicon", "vrpn", "optitrack", "qualisys"})
    if (name.find(part) != std::string::npos) return true;
  return false;
}

/// Reads the messages of a topic, each by `read(message)`, which adds to the poses.
template <typename Read>
void read_all(const LogReader& log, uint16_t topic, Read read) {
  for (const MessagePlace& place : log.places(topic)) {
    try {
      const OwnedMessage message = log.read(place);
      read(message.view());
    } catch (const InputError&) {
      continue;  // a pose that is missing
    }
  }
}

void sort_poses(Trajectory& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
}

/// The poses of a topic.
void read_topic(const LogReader& log, uint16_t topic, ReadPose read, const FrameTree& frames,
                const std::string& camera, LogTruth& truth) {
  truth.topic = log.topics()[topic].name;
  std::string child;
  read_all(log, topic, [&](const SerialisedMessage& message) {
    const TransformMessage pose = read(message);
    child = pose.child;
    truth.poses.push_back({pose.header.stamp, pose.child_to_parent});
  });
  sort_poses(truth.poses);
  const auto to_child = frames.between(camera, child);
  if (to_child) {
    truth.tracked_to_reference = *to_child;
  } else {
    truth.assumptions.push_back(fmt::format(
        "the poses of {} are taken for those of the colour camera: no transform tells more", truth.topic));
  }
}

/// The frame whose motion is the camera's: the only one above it that moves, or that below odom, which map
/// corrects.
std::string moving_frame(const FrameTree& frames, const std::string& camera) {
  std::vector<std::string> moving = frames.moving_above(camera);
  if (moving.size() == 2 && moving.back() == "odom") moving.pop_back();
  return moving.size() == 1 ? moving.front() : "";
}

void read_tf(const LogReader& log, const FrameTree& frames, const std::string& camera, LogTruth& truth) {
  const std::string child = moving_frame(frames, camera);
  const auto to_child = frames.between(camera, child);
  if (child.empty() || !to_child) return;
  for (uint16_t topic = 0; topic < log.topics().size(); ++topic) {
    if (!log.is(topic, "tf2_msgs/TFMessage") && !log.is(topic, "tf/tfMessage")) continue;
    read_all(log, topic, [&](const SerialisedMessage& message) {
      for (const TransformMessage& transform : read_transforms(message))
        if (plain_frame(transform.child) == child)
          truth.poses.push_back({transform.header.stamp, transform.child_to_parent});
    });
    truth.topic = log.topics()[topic].name;
  }
  sort_poses(truth.poses);
  truth.tracked_to_reference = *to_child;
  truth.assumptions.push_back(
      fmt::format("the true poses are those of {} in {}, from {}", child, frames.parent(child), truth.topic));
}

}  // namespace

LogTruth find_truth(const LogReader& log, const FrameTree& frames, const std::string& camera) {
  int best = 0;
  uint16_t best_topic = 0;
  ReadPose read = nullptr;
  for (uint16_t topic = 0; topic < log.topics().size(); ++topic) {
    for (const PoseType& type : kPoseTypes) {
      if (!log.is(topic, type.type) || log.topics()[topic].messages < kFewestPoses) continue;
      const int score = type.score + (is_named_for_truth(log.topics()[topic].name) ? kNamedForTruth : 0);
      if (score <= best) continue;
      best = score;
      best_topic = topic;
      read = type.read;
    }
  }
  LogTruth truth;
  if (read) {
    read_topic(log, best_topic, read, frames, camera, truth);
    if (best < kNamedForTruth)
      truth.assumptions.push_back(fmt::format("the true poses are those of {}", truth.topic));
  } else {
    read_tf(log, frames, camera, truth);
  }
  return truth;
}

}  // namespace surefield
