#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/gpu/device.h"
#include "engine/sources/recording.h"
#include "engine/synth/camera_path.h"
#include "engine/synth/moved_chair.h"
#include "engine/synth/scene_renderer.h"
#include "engine/synth/sensor_model.h"

namespace surefield {

/// Which camera takes a synthetic sequence: an ideal one, or one with the errors of KinectModel.
enum class SensorKind { Perfect, Kinect };

/// Which synthetic sequence to make. The default is the embedded sequence of the demo.
struct SynthSettings {
  std::string scene = "office";   ///< see scene_names()
  std::string path = "handheld";  ///< see path_names()
  int width = 320;                ///< pixels
  int height = 240;               ///< pixels
  int frames = 60;                ///< number of frames, at 30 a second
  uint32_t seed = 1;              ///< of the scene, the path and the sensor
  SensorKind sensor = SensorKind::Perfect;
  KinectModel kinect;  ///< of SensorKind::Kinect; the seed is that of the sequence, and a jump of its
                       ///< exposure where `exposure_from` says
  /// So many single views beside the path, in place of the frames on it: 10 cm and 4 degrees away from where
  /// the camera is at evenly spaced times, taken by an ideal camera. 0: the frames.
  int beside = 0;
  bool moving_object = false;        ///< somebody walks through the scene; not in its mesh
  bool moved_chair = false;          ///< a chair stands elsewhere when it is seen again (moved_chair.h)
  std::optional<int> exposure_from;  ///< frame of a jump of the exposure; none: the middle
};

/// A walk through a synthetic scene as a sequence with exact ground truth: needs no files, renders each frame
/// when it is loaded. The same settings give the same bits on every run on one device.
class SyntheticRecording : public Recording {
 public:
  /// Opens a device of its own. Throws InputError where a setting is wrong, gpu::Error where there is no
  /// device.
  explicit SyntheticRecording(const gpu::DeviceOptions& device, const SynthSettings& settings = {});

  std::string name() const override { return "synthetic"; }
  std::string format() const override { return "synthetic"; }
  int count() const override { return settings_.beside > 0 ? settings_.beside : settings_.frames; }
  /// Square pixels, centred, a horizontal field of view of about 61 degrees.
  Intrinsics intrinsics() const override;
  /// 1: depth is made in metres and never rounded to steps.
  double depth_unit() const override { return 1.0; }
  /// i / 30 seconds: when the depth image is taken (the middle of its rows), for which the true pose is
  /// given.
  double timestamp(int i) const override { return i / 30.0; }
  /// The middle of the colour image's exposure; later than timestamp() with the Kinect.
  double colour_timestamp(int i) const;
  /// The true pose, camera to world, at any time from the first frame to the last; of views beside the path,
  /// at their timestamp().
  Pose true_pose(double seconds) const;
  LoadedFrame load(int i) const override;
  /// true_pose() at the stamps of all frames.
  const Trajectory& ground_truth() const { return ground_truth_; }

  const SynthSettings& settings() const { return settings_; }
  /// As it is in the end.
  const Scene& scene() const { return moved_ ? moved_->scene : scene_; }
  /// The frame from which on a chair stands elsewhere; none where none moves.
  std::optional<int> chair_moved_at() const { return moved_ ? std::optional(moved_->frame) : std::nullopt; }

 private:
  std::vector<Pose> poses_around(double middle, double span, int count) const;
  bool is_kinect() const { return settings_.sensor == SensorKind::Kinect && settings_.beside == 0; }
  Pose pose_beside(int i) const;
  Exposure exposure_of(int i) const;
  std::vector<double> visible_shares(int i) const;
  /// What frame `i` shows: the scene before a chair was moved, or after.
  const SceneRenderer& renderer_of(int i) const;

  SynthSettings settings_;
  KinectModel kinect_;
  Scene scene_;
  CameraPath path_;
  std::unique_ptr<gpu::Device> device_;
  SceneRenderer renderer_;
  std::optional<MovedChair> moved_;
  std::unique_ptr<SceneRenderer> moved_renderer_;
  Trajectory ground_truth_;
};

}  // namespace surefield
