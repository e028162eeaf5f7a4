#pragma once

#include "engine/splat/rasteriser.h"
#include "engine/splat/sensor_frame.h"
#include "shaders/shared/mapping_gradient.h"
#include "shaders/shared/refine_pose.h"
#include "shaders/shared/ssim_columns.h"
#include "shaders/shared/ssim_rows.h"
#include "shaders/shared/ssim_slope_rows.h"
#include "shaders/shared/sum_losses.h"
#include "shaders/shared/update_colours.h"
#include "shaders/shared/update_gaussians.h"

namespace surefield {

/// A keyframe's camera on the device with the optimiser's state for its pose, and its exposure.
struct CameraVariable {
  gpu::Array<glsl::CameraState> camera;
  gpu::Array<glsl::PoseAdam> adam;
  glsl::vec3 gains;  ///< the sensor's colours times these are those of the map

  CameraVariable(gpu::Device& device, const Camera& initial,
                 const Eigen::Vector3f& view_gains = Eigen::Vector3f::Ones());
  /// Puts a camera in the place of the one before; its pose starts without the optimiser's state.
  void assign(const Camera& initial, const Eigen::Vector3f& view_gains = Eigen::Vector3f::Ones());
};

/// A step of mapping on one view.
struct MappingStep {
  const SensorFrame& frame;
  CameraVariable& camera;
  bool refine_pose = false;
  bool same_lists = false;  ///< View::same_lists
};

/// Optimises the map, and poses beside it, with all six losses (paper eq. 14 to 18 and 21).
class Mapper {
 public:
  explicit Mapper(gpu::Device& device);

  /// Records render, mapping loss and dL/d(images): the gradient lands in rasteriser.pixel_upstream.
  void record_loss(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map,
                   const SensorFrame& frame, const CameraVariable& camera, const MappingSettings& settings,
                   bool same_lists = false);

  /// Records one step: loss, backward, Adam on every visible Gaussian and, if asked, on the pose.
  /// `pixel`: metres, that one covers at the scene's distance.
  void record_step(gpu::Recorder& recorder, Rasteriser& rasteriser, GaussianMap& map, const MappingStep& step,
                   const MappingSettings& settings, double pixel);

  /// The weighted loss that the last submitted record_loss() computed, without L_iso.
  double read_loss(const SensorFrame& frame, const MappingSettings& settings) const;

  gpu::Array<glsl::LossSums> loss;  ///< sums of the last record_loss()

 private:
  void record_ssim(gpu::Recorder& recorder, const Rasteriser& rasteriser, const SensorFrame& frame,
                   const glsl::vec3& gains);
  void record_update(gpu::Recorder& recorder, const Rasteriser& rasteriser, GaussianMap& map,
                     const MappingSettings& settings, double pixel);
  gpu::Pass<passes::update_colours>& colour_update(int sh_degree);

  gpu::Device& device_;
  gpu::Pass<passes::ssim_rows> ssim_rows_;
  gpu::Pass<passes::ssim_columns> ssim_columns_;
  gpu::Pass<passes::ssim_slope_rows> ssim_slope_rows_;
  gpu::Pass<passes::mapping_gradient> gradient_alpha_;
  gpu::Pass<passes::mapping_gradient> gradient_normalised_;
  gpu::Pass<passes::sum_losses> sum_losses_;
  gpu::Pass<passes::update_gaussians> update_;
  gpu::Pass<passes::refine_pose> refine_pose_;
  std::unique_ptr<gpu::Pass<passes::update_colours>> update_colours_[4];

  gpu::Array<glsl::SsimMoments> moments_;
  gpu::Array<glsl::SsimSlopes> slopes_;
  gpu::Array<glsl::SsimSlopes> row_slopes_;
  gpu::Array<float> ssim_partials_;
  gpu::Array<glsl::LossSums> loss_partials_;
  gpu::Array<glsl::uint> median_count_;
};

}  // namespace surefield
