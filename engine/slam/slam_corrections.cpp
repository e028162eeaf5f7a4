// What is put right once a later frame shows it: where the first depth was taken, what moves, in which light
// a run began.
#include <utility>

#include "engine/slam/depth_timing.h"
#include "engine/slam/moved_things.h"
#include "engine/slam/slam_implementation.h"

namespace surefield {

namespace {

constexpr double kNoticed = 0.5;  // pixels by which depth and colour of the first frame may be apart
constexpr float kDim = 2.5f;  // times as bright as those before, a keyframe shows that they were in the dark
constexpr int kDimKeyframes = 3;  // the first ones, that may have been

}  // namespace

bool Slam::Implementation::shows_depth_moved(const FrameReport& second) const {
  if (!first_frame || second.state != TrackingState::Good) return false;
  const Pose motion = depth_to_colour(first_frame->depth_after, motion_from_first(second));
  return largest_shift(first_frame->depth, intrinsics, motion) > kNoticed;
}

CameraMotion Slam::Implementation::motion_from_first(const FrameReport& second) const {
  return {second.world_to_camera * history.world_to_camera(0).inverse(),
          second.timestamp - history.report(0).timestamp};
}

void Slam::Implementation::begin_again(const FrameReport& second) {
  Frame first = *std::exchange(first_frame, std::nullopt);
  const CameraMotion motion = motion_from_first(second);
  tracker.expect(motion);
  first.depth = move_depth(first.depth, intrinsics, depth_to_colour(first.depth_after, motion));
  FrameReport report = history.last_report();
  Sighting sighting = sight_first(first, make_colour_grid(first), report);
  Keyframe keyframe =
      make_keyframe(first, sighting.image.keep(), keyframes[0].camera, std::move(sighting.points));
  keyframe.grid = std::move(sighting.grid);
  keyframe.features = std::move(sighting.features);
  engine.release(keyframes[0].frame);
  keyframes.replace_first(std::move(keyframe));
  map_first(first);
}

void Slam::Implementation::hide_moved(Frame& mapped) {
  const DepthNoise noise = noise_of(settings.sensor);
  const auto view_of_keyframe = [&](int k) { return DepthView{keyframes[k].grid, keyframes[k].camera}; };
  const int newest = keyframes.newest();
  std::vector<DepthView> others;
  for (int k : keyframes.window()) others.push_back(view_of_keyframe(k));
  const DepthView own = view_of_keyframe(newest);
  const std::vector<uint8_t> cells = moved_cells(own, others, noise);
  for (int k : keyframes.window()) hide(k, moved_cells(view_of_keyframe(k), std::span(&own, 1), noise));
  if (cells.empty()) return;
  std::vector<uint8_t> pixels = hide(newest, cells);
  mapped.depth = mapped.depth.clone();
  mapped.depth.setTo(0, cv::Mat(mapped.depth.size(), CV_8U, pixels.data()));
  history.last_report().moved = cv::mean(pixels)[0];
}

void Slam::Implementation::brighten_dim() {
  const Eigen::Vector3f as_it_is = Eigen::Vector3f::Ones();
  const Keyframe& newest = keyframes[keyframes.newest()];
  if (keyframes.newest() > kDimKeyframes) return;
  for (const Keyframe& keyframe : keyframes.all())
    if (keyframe.light != as_it_is) return;
  const std::vector<LitView> bright{{newest.grid, as_it_is, newest.camera}};
  std::vector<Eigen::Vector3f> gains;
  for (int k = 0; k < keyframes.newest(); ++k) {
    gains.push_back(find_gains(keyframes[k].grid, keyframes[k].camera, bright, as_it_is, kDim - 1));
    if (!(gains.back().minCoeff() > kDim)) return;
  }
  for (int k = 0; k < keyframes.newest(); ++k) keyframes.set_light(k, gains[k]);
  GaussianCloud cloud = engine.map();
  scale_colours(cloud, gains.back());
  engine.assign(cloud, settings.depth_model);
  history.multiply_gains(gains.back());
  history.last_report().gains = as_it_is;
}

/// Takes these cells out of a keyframe; returns the flags of their pixels.
std::vector<uint8_t> Slam::Implementation::hide(int k, const std::vector<uint8_t>& cells) {
  if (cells.empty()) return {};
  const Keyframe& keyframe = keyframes[k];
  const auto pixels = pixels_of_cells(cells, keyframe.grid, {intrinsics.width, intrinsics.height});
  engine.hide(keyframe.frame, pixels);
  if (keyframe.tracked != keyframe.frame) engine.hide(keyframe.tracked, pixels);
  keyframes.forget_depth(k, cells);
  return pixels;
}

void Slam::Implementation::settle_exposure() {
  if (const auto gains = history.usual_gains()) {
    map_gains = gains->cwiseInverse();
    history.multiply_gains(map_gains);
  }
}

}  // namespace surefield
