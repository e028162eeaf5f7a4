#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/splat/camera.h"
#include "engine/splat/depth_model.h"
#include "engine/splat/gaussian_cloud.h"
#include "engine/splat/pose_gradient.h"
#include "engine/splat/render_images.h"

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

/// How a pose is tracked (paper eq. 19 and 20).
struct TrackingSettings {
  TrackingMethod method = TrackingMethod::GaussNewton;
  int renders = 1;       ///< Gauss-Newton: times that the map is rendered and aligned, at most
  double balance = 1.5;  ///< Gauss-Newton: weight of the geometric residuals beside the photometric ones
  int references = 4;    ///< Gauss-Newton: keyframes whose images a frame is aligned to, at most
  double reference_weight = 1;        ///< Gauss-Newton: weight of each of them beside the render
  int iterations = 35;                ///< Adam's steps, at most
  double rate_rotation = 0.0015;      ///< Adam's step, radians
  double rate_translation = 0.00215;  ///< Adam's step, metres
  double weight_colour = 1.0;         ///< lambda_1
  double weight_depth = 0.6;          ///< lambda_2
  double minimum_opacity = 0.5;       ///< pixels take part where O is above
  double outlier_factor = 10;         ///< and where the residual is below this many times the median
  double uncertainty_above = 0.025;   ///< tau, m^2: more uncertain Gaussians take no part; 0: all do
  DepthKind depth = DepthKind::Normalised;
  PoseGradientKind pose_gradient = PoseGradientKind::Full;
  double stop_below = 2e-5;  ///< stop when steps of all pose numbers have become smaller (radians, metres)
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
  std::vector<std::string> validation_messages;
};

/// The Gaussian field and everything that is done to it, in a handful of verbs on plain data. All heavy work
/// runs as compute kernels on a Vulkan device; gpu::Error is thrown when that fails. Not thread-safe.
class SplatEngine {
 public:
  explicit SplatEngine(const EngineOptions& options = {});
  ~SplatEngine();

  /// Takes a frame in, or releases it. The images of a few frames are on the device, those of the others wait
  /// in host memory, without loss, until they are asked for.
  FrameHandle load(const FrameView& frame);
  void release(FrameHandle frame);

  /// Replaces the map, adds Gaussians to it, reads it back.
  void assign(const GaussianCloud& cloud);
  void insert(const GaussianCloud& cloud);
  GaussianCloud map() const;
  uint32_t size() const;
  /// Gaussians on the device; see set_map_budget().
  uint32_t device_size() const;

  /// Sets the depth of a Gaussian over its footprint, of everything from here on; at first it is a plane's.
  void set_depth_model(DepthModel model);

  /// Sets how much device memory the Gaussians may take, with all that is kept for each of them. The map is
  /// then in two parts: what focus() and recall() ask for is on the device, and everything else waits in host
  /// memory, as it was. All verbs but map(), size() and render_whole() work on the part on the device.
  void set_map_budget(uint64_t bytes);
  /// Whether the whole map is on the device, with room for so many more Gaussians.
  bool is_whole(uint32_t births = 0) const;
  /// Brings back the Gaussians near these places: within half a metre, and up to half a metre more. Returns
  /// false, with nothing done, when there is no room for them.
  bool recall(const WorldPoints& points);
  /// Has on the device what is near the places of regions[0], and of as many more regions, in this order, as
  /// there is room for beside so many `births`; moves the rest to host memory where it is worth it. Returns
  /// how many regions are on the device: at least the first, of which there may be a part, nearest its
  /// places, when there is no room for all of it.
  int focus(std::span<const WorldPoints> regions, uint32_t births);

  /// Renders a camera; with sensor depth (metres, row-major), also the uncertainty.
  RenderImages render(const Camera& camera) const;
  RenderImages render(const Camera& camera, std::span<const float> sensor_depth) const;
  /// Renders the whole map: for that time it is on the device beyond the budget.
  RenderImages render_whole(const Camera& camera) const;

  /// Finds the pose of a frame in the fixed map, starting from that of `start`. Gauss-Newton aligns it to the
  /// first four `references` too; Adam does not. Throws std::invalid_argument where one is of another size.
  TrackingResult track(FrameHandle frame, const Camera& start, const TrackingSettings& settings,
                       std::span<const TrackingReference> references = {});

  /// Optimises the map over views[order[0]], views[order[1]], ..., one step each, and the poses of the views
  /// that ask for it. `extent` (metres) scales the rates of means and scales.
  MappingResult optimise(std::span<MappingView> views, std::span<const int> order,
                         const MappingSettings& settings, double extent);

  /// Computes the uncertainty of the Gaussians that dominate pixels of the views (paper eq. 13) and lowers
  /// the opacity of the uncertain ones. Does nothing where `settings` says that none is judged.
  JudgeResult judge(std::span<const MappingView> views, const MappingSettings& settings);

  /// Splits, clones and removes; the statistics that decide are those gathered since the last call.
  DensifyResult densify(const DensifySettings& settings);

  EngineReport report() const;
  /// Device memory in use now.
  uint64_t device_bytes() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace surefield
