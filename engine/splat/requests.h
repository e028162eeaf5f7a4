#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/gpu/device_counters.h"
#include "engine/splat/pose_gradient.h"
#include "engine/types/camera.h"

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
  const float* depth = nullptr;     ///< metres; invalid where not finite, not positive or beyond depth_max
  float depth_max = 0;              ///< metres
};

/// How tracking minimises its loss.
enum class TrackingMethod { GaussNewton, Adam };

/// What second-order tracking does (docs/method.md, "Second-order tracking").
struct GaussNewtonSettings {
  int renders = 1;              ///< times that the map is rendered and aligned, at most
  double balance = 1.5;         ///< weight of the geometric residuals beside the photometric ones
  int references = 4;           ///< keyframes whose images a frame is aligned to, at most
  double reference_weight = 1;  ///< weight of each of them beside the render
};

/// What tracking by Adam does (paper eq. 20).
struct AdamSettings {
  int iterations = 35;                ///< steps, at most
  int first_iterations = 100;         ///< those of the first frame that Slam tracks, where they are more
  double rate_rotation = 0.0015;      ///< step, radians
  double rate_translation = 0.00215;  ///< step, metres
  PoseGradientKind pose_gradient = PoseGradientKind::Full;
  double stop_below = 2e-5;  ///< stop when steps of all pose numbers have become smaller (radians, metres)
};

/// How a pose is tracked: the loss (paper eq. 19 and 20), by which either method judges poses, and what each
/// method does to lower it.
struct TrackingSettings {
  TrackingMethod method = TrackingMethod::GaussNewton;
  double weight_colour = 1.0;        ///< lambda_1
  double weight_depth = 0.6;         ///< lambda_2
  double minimum_opacity = 0.5;      ///< pixels take part where O is above
  double outlier_factor = 10;        ///< and where the residual is below this many times the median
  double uncertainty_above = 0.025;  ///< tau, m^2: more uncertain Gaussians take no part; 0: all do
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
  int iterations = 0;
  double milliseconds = 0;
};

/// How the map is optimised (paper eq. 18 and 21). Rates are Adam's steps.
struct MappingSettings {
  double weight_colour = 1.0;
  double weight_ssim = 0.1;
  double weight_depth = 0.8;
  double weight_align = 0.1;
  double weight_isotropy = 0.1;
  double isotropy_epsilon = 5;  ///< L_iso begins where the largest scale is so many times the smallest
  double weight_variance = 0.5;
  DepthKind depth = DepthKind::Normalised;
  double uncertainty_above = 0.025;  ///< tau, m^2: Gaussians above lose their opacity; 0: none is judged
  double uncertain_opacity = 0.01;   ///< what is left of it
  double rate_mean = 3e-4;           ///< times extent, metres
  double rate_log_scale = 1e-4;      ///< times extent
  double rate_rotation = 1e-3;
  double rate_opacity = 5e-2;
  double rate_colour = 2.5e-3;       ///< SH of degree 0; the higher ones move at a twentieth of it
  double rate_pose_rotation = 0;     ///< radians
  double rate_pose_translation = 0;  ///< metres
  PoseGradientKind pose_gradient = PoseGradientKind::Full;
};

/// A keyframe that takes part in mapping.
struct MappingView {
  FrameHandle frame = 0;
  Camera camera;  ///< the pose is refined in place where `refine_pose` says so
  bool refine_pose = false;
  Eigen::Vector3f gains = Eigen::Vector3f::Ones();  ///< times its colours are those of the map
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

/// When Gaussians are split, cloned and removed (3D Gaussian splatting's adaptive control).
struct DensifySettings {
  double gradient_threshold = 2e-3;  ///< mean screen gradient, in units of half the image
  double split_scale = 0.01;         ///< larger ones are split, smaller ones cloned; times extent, metres
  double minimum_opacity = 0.005;    ///< fainter ones are removed
  double maximum_scale = 0.1;        ///< larger ones are removed; times extent, metres
  double extent = 1;                 ///< size of the scene, metres
  uint64_t seed = 0;                 ///< where split children fall
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
  uint64_t map_bytes = 0;          ///< parameters of the Gaussians
  uint64_t device_peak_bytes = 0;  ///< most device memory in use at any time
  gpu::DeviceCounters device_use;  ///< since the engine was made
  std::vector<std::string> validation_messages;
};

}  // namespace surefield
