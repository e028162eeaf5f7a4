#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/gpu/device_counters.h"
#include "engine/splat/pose_evidence.h"
#include "engine/splat/pose_gradient.h"
#include "engine/types/camera.h"
#include "engine/types/depth_noise.h"

namespace surefield {

/// Where and how the engine runs.
struct EngineOptions {
  std::string device;     ///< index or part of a name; empty: the best there is
  bool validate = false;  ///< Vulkan's validation layer, for debugging
};

/// Which rendered depth the depth terms of a loss use.
enum class DepthKind { Alpha, Normalised };

/// A frame that the engine holds.
using FrameHandle = int;

/// Places in the world, metres.
using WorldPoints = std::vector<Eigen::Vector3f>;

/// Images of one frame in host memory, row-major.
struct FrameView {
  int width = 0;
  int height = 0;
  const uint8_t* colour = nullptr;  ///< RGB, 3 bytes a pixel
  const float* depth = nullptr;     ///< metres; invalid where not finite or not positive
  DepthNoise noise = noise_of(DepthSensor::StructuredLight);  ///< of the depth
};

/// How tracking minimises its loss.
enum class TrackingMethod { GaussNewton, Adam };

/// What second-order tracking does (docs/method.md, "Second-order tracking"): `gauss_newton` in
/// configs/base.yaml, which says what each key means.
struct GaussNewtonSettings {
  int renders = 1;
  double balance = 1.5;
  int references = 4;
  double reference_weight = 1;
};

/// What tracking by Adam does (paper eq. 20): `adam` in configs/base.yaml. The engine takes `iterations`
/// steps; Slam makes them `first_iterations` where it is time to.
struct AdamSettings {
  int iterations = 35;
  int first_iterations = 100;
  double rate_rotation = 0.0015;
  double rate_translation = 0.00215;
  PoseGradientKind pose_gradient = PoseGradientKind::Full;
  double stop_below = 2e-5;
};

/// How a pose is tracked: the loss (paper eq. 19 and 20), by which either method judges poses (`tracking` in
/// configs/base.yaml), and what each method does to lower it.
struct TrackingSettings {
  TrackingMethod method = TrackingMethod::GaussNewton;
  double weight_colour = 1.0;
  double weight_depth = 0.6;
  double minimum_opacity = 0.5;
  double outlier_factor = 10;
  double uncertainty_above = 0.025;
  DepthKind depth = DepthKind::Normalised;
  GaussNewtonSettings gauss_newton;
  AdamSettings adam;
};

/// A keyframe whose images a frame is aligned to beside the map, with its camera, whose intrinsics are the
/// frame's.
struct TrackingReference {
  FrameHandle frame = 0;
  Camera camera;
};

/// What tracking found.
struct TrackingResult {
  Pose world_to_camera = Pose::Identity();  ///< the pose of the lowest loss
  double loss = 0;                          ///< that loss
  double valid_fraction = 0;                ///< pixels in the depth mask, of all with sensor depth
  double explained = 0;                     ///< pixels whose depth the map explains, of all with sensor depth
  double seen_through = 0;  ///< pixels where the sensor sees through the map, of all with sensor depth
  PoseEvidence evidence;
  int iterations = 0;
  double milliseconds = 0;
};

/// What aligning one frame to another alone found.
struct PairAlignment {
  Pose world_to_camera = Pose::Identity();
  PoseEvidence evidence;
};

/// How the map is optimised (paper eq. 18 and 21): `mapping` in configs/base.yaml.
struct MappingSettings {
  double weight_colour = 1.0;
  double weight_ssim = 0.1;
  double weight_depth = 0.8;
  double weight_align = 0.1;
  double weight_isotropy = 0.1;
  double isotropy_epsilon = 5;
  double weight_variance = 0.5;
  DepthKind depth = DepthKind::Normalised;
  double uncertainty_above = 0.025;
  double uncertain_opacity = 0.01;
  double rate_centre = 0.1;  ///< pixels at the scene's distance
  double rate_size = 1.5e-3;
  double rate_rotation = 5e-3;
  double rate_opacity = 5e-2;
  double rate_colour = 5e-3;
  double rate_pose_rotation = 0;
  double rate_pose_translation = 0;
  PoseGradientKind pose_gradient = PoseGradientKind::Full;
};

/// A keyframe that takes part in mapping.
struct MappingView {
  FrameHandle frame = 0;
  Camera camera;  ///< the pose is refined in place where `refine_pose` says so
  bool refine_pose = false;
  Eigen::Vector3f gains = Eigen::Vector3f::Ones();  ///< times its colours are those of the map
};

/// When the steps of a mapping call end before all are done.
struct MappingLimit {
  std::stop_token stop;
  /// From then on no further step begins, but for the first; nullopt: the call has the time it takes.
  std::optional<std::chrono::steady_clock::time_point> until = std::nullopt;

  /// Whether no step may follow the `done` ones.
  bool reached(std::size_t done) const {
    return stop.stop_requested() || (until && done > 0 && std::chrono::steady_clock::now() >= *until);
  }
};

/// What a mapping call did.
struct MappingResult {
  double loss = 0;  ///< of the last step, without L_iso
  int iterations = 0;
  double milliseconds = 0;
};

/// What judging found.
struct JudgeResult {
  uint32_t uncertain = 0;  ///< Gaussians on the device whose uncertainty is above the limit
  double milliseconds = 0;
};

/// When Gaussians are split, cloned and removed (3D Gaussian splatting's adaptive control): `densify` in
/// configs/base.yaml, beside what the caller knows of the scene.
struct DensifySettings {
  double gradient_threshold = 2e-3;
  double split_scale = 0.01;
  double minimum_opacity = 0.005;
  double maximum_scale = 0.1;
  double extent = 1;  ///< size of the scene, metres
  uint64_t seed = 0;  ///< where split children fall
};

/// How many Gaussians a densification added and removed.
struct DensifyResult {
  int cloned = 0;
  int split = 0;
  int pruned = 0;
};

/// What the engine runs on and needs.
struct EngineReport {
  std::string device;
  std::string driver;
  bool is_cpu = false;             ///< a software implementation
  uint64_t map_bytes = 0;          ///< parameters of the Gaussians
  uint64_t device_peak_bytes = 0;  ///< most device memory in use at any time
  gpu::DeviceCounters device_use;  ///< since the engine was made
  std::vector<std::string> validation_messages;
};

}  // namespace surefield
