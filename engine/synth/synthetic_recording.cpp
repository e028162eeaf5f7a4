#include "engine/synth/synthetic_recording.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/synth/random.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kFrameRate = 30;
constexpr int kColourPoses = 9;     // in which the way of the camera during one colour image is cut
constexpr int kDepthPoses = 5;      // and during one depth image that is not taken at once
constexpr int kBlurredSamples = 8;  // of colour, a pixel

// Views beside the path: how far away, metres and radians; directions that are tried, and how near nothing
// may stand.
constexpr double kBeside = 0.10, kBesideTurn = 4 * std::numbers::pi / 180;
constexpr int kDirections = 8;
constexpr double kFree = 0.4;  // metres

const SynthSettings& checked(const SynthSettings& settings) {
  if (settings.width < 1 || settings.height < 1 || settings.frames < 1 || settings.beside < 0) {
    throw InputError(
        "synthetic sequence: width, height and frames must be at least 1, views beside the path not "
        "negative");
  }
  return settings;
}

}  // namespace

SyntheticRecording::SyntheticRecording(const gpu::DeviceOptions& device, const SynthSettings& settings)
    : settings_(checked(settings)),
      kinect_(settings.kinect),
      scene_(make_scene(settings.scene, settings.seed)),
      path_(scene_, path_style(settings.path), settings.seed, settings.frames / kFrameRate),
      device_(std::make_unique<gpu::Device>(device)),
      renderer_(*device_, scene_, settings.moving_object) {
  kinect_.seed = settings.seed;
  kinect_.jump_seconds = timestamp(settings.exposure_from.value_or(settings.frames / 2));
  if (settings.moved_chair) {
    moved_ = move_chair(scene_, settings.frames, [this](int i) { return visible_shares(i); });
    moved_renderer_ = std::make_unique<SceneRenderer>(*device_, moved_->scene, settings.moving_object);
  }
  for (int i = 0; i < count(); ++i) {
    const Pose world_to_camera = settings.beside > 0 ? pose_beside(i) : path_.world_to_camera(timestamp(i));
    ground_truth_.push_back({timestamp(i), world_to_camera.inverse()});
  }
}

/// The share of a small image of frame `i` that each object takes.
std::vector<double> SyntheticRecording::visible_shares(int i) const {
  const Intrinsics small{64, 48, 54.4, 54.4, 31.5, 23.5};
  const cv::Mat shapes = renderer_.render(Camera{small, path_.world_to_camera(timestamp(i))}).shapes;
  std::vector<double> shares(scene_.objects.size(), 0);
  for (const int shape : cv::Mat_<int>(shapes)) {
    // The visitor's shapes follow those of the scene.
    if (shape < 0 || shape >= static_cast<int>(scene_.shapes.size())) continue;
    const Shape& hit = scene_.shapes[static_cast<std::size_t>(shape)];
    shares[static_cast<std::size_t>(hit.object)] += 1.0 / static_cast<double>(shapes.total());
  }
  return shares;
}

const SceneRenderer& SyntheticRecording::renderer_of(int i) const {
  return moved_ && (settings_.beside > 0 || i >= moved_->frame) ? *moved_renderer_ : renderer_;
}

Pose SyntheticRecording::true_pose(double seconds) const {
  if (settings_.beside == 0) return path_.world_to_camera(seconds).inverse();
  const auto i = static_cast<std::size_t>(std::lround(seconds * kFrameRate));
  return ground_truth_[std::min(i, ground_truth_.size() - 1)].camera_to_world;
}

/// Moved to one side and turned towards another, both in the image plane, world to camera: the first of some
/// directions in which nothing stands in the way, else the one with the most room.
Pose SyntheticRecording::pose_beside(int i) const {
  const double duration = settings_.frames / kFrameRate;
  const Pose on_path = path_.world_to_camera(duration * (i + 0.5) / settings_.beside);
  Pose roomiest = on_path;
  double most = -1;
  for (int n = 0; n < kDirections && most < kFree; ++n) {
    RandomStream random(hash_key(settings_.seed, static_cast<uint32_t>(kDirections * i + n)));
    const auto direction = [&] {
      const double angle = random.uniform(0, 2 * std::numbers::pi);
      return Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    };
    const Pose aside = Eigen::Translation3d(kBeside * direction()) * on_path;
    const Pose pose = Eigen::AngleAxisd(kBesideTurn, direction()) * aside;
    const cv::Mat depth = renderer_of(i).render(Camera{intrinsics(), pose}).depth;
    double nearest = 0;
    cv::minMaxLoc(depth, &nearest);
    if (nearest <= most) continue;
    most = nearest;
    roomiest = pose;
  }
  return roomiest;
}

Intrinsics SyntheticRecording::intrinsics() const {
  const double focal_length = 0.85 * settings_.width;
  return {settings_.width,
          settings_.height,
          focal_length,
          focal_length,
          0.5 * (settings_.width - 1),
          0.5 * (settings_.height - 1)};
}

double SyntheticRecording::colour_timestamp(int i) const {
  return timestamp(i) + (is_kinect() ? kinect_.colour_delay : 0);
}

/// So many poses, evenly spaced over a time, with `middle` in its middle.
std::vector<Pose> SyntheticRecording::poses_around(double middle, double span, int count) const {
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / (count - 1) - 0.5;
    poses.push_back(path_.world_to_camera(middle + span * part));
  }
  return poses;
}

Exposure SyntheticRecording::exposure_of(int i) const {
  Exposure exposure;
  exposure.intrinsics = intrinsics();
  exposure.depth_poses = {true_pose(timestamp(i)).inverse()};
  exposure.visitor_seconds = timestamp(i);
  if (!is_kinect()) {
    exposure.colour_poses = exposure.depth_poses;
    return exposure;
  }
  if (kinect_.depth_readout_seconds > 0)
    exposure.depth_poses = poses_around(timestamp(i), kinect_.depth_readout_seconds, kDepthPoses);
  const double span = kinect_.readout_seconds + kinect_.exposure_seconds;
  exposure.colour_poses = poses_around(colour_timestamp(i), span, kColourPoses);
  exposure.readout = kinect_.readout_seconds / span;
  exposure.exposure = kinect_.exposure_seconds / span;
  exposure.samples = kBlurredSamples;
  exposure.brightness = kinect_.brightness(timestamp(i));
  exposure.seed = hash_key(settings_.seed, static_cast<uint32_t>(i));
  return exposure;
}

LoadedFrame SyntheticRecording::load(int i) const {
  SceneImages images = renderer_of(i).render(exposure_of(i));
  Frame frame;
  frame.index = i;
  frame.timestamp = timestamp(i);
  frame.colour = std::move(images.colour);
  frame.depth = std::move(images.depth);
  if (is_kinect()) {
    kinect_.add_colour_noise(frame.colour, i);
    frame.depth = kinect_.depth(frame.depth, intrinsics(), i);
  }
  return {std::move(frame), ""};
}

}  // namespace surefield
