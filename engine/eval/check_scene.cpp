#include "engine/eval/check_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/sources/frame_stream.h"

namespace surefield {

namespace {

constexpr double kWidth = 320;          // pixels; finer images tell no more and take longer
constexpr int kPairs = 24;              // spread over the sequence
constexpr int kFramesAlone = 40;        // without poses
constexpr int kFarthest = 60;           // frames between the two of a pair
constexpr double kEnoughMotion = 0.12;  // metres
constexpr double kMostMotion = 0.4;     // metres
constexpr double kMostTurn = 0.25;      // radians: beyond, too little is seen twice

/// The first later frame that has moved far enough, or the one that has moved most; -1 where there is none.
int partner(const Recording& recording, const PoseTrack& track, int from) {
  const auto pose = track.at(recording.timestamp(from));
  int best = -1;
  double most = 0;
  if (!pose) return best;
  for (int to = from + 1; to < recording.count() && to <= from + kFarthest; ++to) {
    const auto other = track.at(recording.timestamp(to));
    if (!other) continue;
    const Eigen::Isometry3d motion = other->inverse() * *pose;
    const double moved = motion.translation().norm();
    if (Eigen::AngleAxisd(motion.linear()).angle() > kMostTurn || moved > kMostMotion) continue;
    if (moved > most) {
      most = moved;
      best = to;
    }
    if (moved >= kEnoughMotion) break;
  }
  return best;
}

/// Loads frames, each once, and knows their places in the scene.
class Loader {
 public:
  Loader(const Recording& recording, PreparedScene& prepared) : recording_(recording), prepared_(prepared) {}

  /// The place of frame `i`; -1 where it cannot be read.
  int place(int i) {
    const auto known = places_.find(i);
    if (known != places_.end()) return known->second;
    const LoadedFrame loaded = recording_.load(i);
    int place = -1;
    if (loaded.frame) {
      place = static_cast<int>(prepared_.scene.frames.size());
      prepared_.scene.frames.push_back(
          prepare_frame(resize_frame(*loaded.frame, prepared_.scale), recording_.depth_timestamp(i)));
    }
    places_[i] = place;
    return place;
  }

 private:
  const Recording& recording_;
  PreparedScene& prepared_;
  std::map<int, int> places_;
};

}  // namespace

std::vector<int> spread(int size, int count) {
  std::vector<int> numbers;
  for (int k = 0; k < std::min(size, count); ++k) {
    numbers.push_back(size <= count ? k : static_cast<int>((2L * k + 1) * size / (2L * count)));
  }
  return numbers;
}

bool stamps_are_indices(const Recording& recording) {
  for (int i = 0; i < recording.count(); ++i) {
    const double stamp = recording.timestamp(i);
    if (stamp != std::floor(stamp) || stamp > 1e7) return false;
  }
  return true;
}

PreparedScene prepare_scene(const Recording& recording, const Trajectory* truth,
                            const std::function<bool()>& stop) {
  PreparedScene prepared;
  prepared.stamps_are_indices = stamps_are_indices(recording);
  prepared.scale = std::min(1.0, kWidth / recording.intrinsics().width);
  CheckScene& scene = prepared.scene;
  scene.intrinsics = recording.intrinsics().scaled(prepared.scale);
  if (truth) scene.track = PoseTrack(of_tracked_camera(*truth, recording));
  bool posed = false;
  for (int i = 0; i < recording.count() && !posed; ++i)
    posed = scene.track.at(recording.timestamp(i)).has_value();
  if (!posed) scene.track = PoseTrack();
  Loader loader(recording, prepared);
  const bool alone = scene.track.empty();
  for (int i : spread(recording.count(), alone ? kFramesAlone : kPairs)) {
    if (stop && stop()) break;
    const int from = loader.place(i);
    if (alone || from < 0) continue;
    const int other = partner(recording, scene.track, i);
    const int to = other < 0 ? -1 : loader.place(other);
    if (to >= 0) scene.pairs.push_back({static_cast<std::size_t>(from), static_cast<std::size_t>(to)});
  }
  return prepared;
}

}  // namespace surefield
