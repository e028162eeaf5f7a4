#pragma once

#include <limits>

#include "engine/splat/pose_gradient.h"
#include "engine/splat/tile_lists.h"
#include "engine/types/camera.h"
#include "engine/types/render_images.h"
#include "shaders/shared/blend_backward.h"
#include "shaders/shared/blend_backward_pose.h"
#include "shaders/shared/blend_forward.h"
#include "shaders/shared/project_backward.h"
#include "shaders/shared/reduce_pose.h"

namespace surefield {

/// A vector as kernels read it.
glsl::vec3 to_vec3(const Eigen::Vector3f& v);
/// The camera as kernels read it.
glsl::CameraState to_device(const Camera& camera);
/// Back to the pose that a kernel has moved; R is made orthonormal again.
Pose pose_of(const glsl::CameraState& state);

/// A view on the device: the camera (which pose optimisation moves) and the sensor's depth, 0 where invalid.
/// Gaussians whose uncertainty is above `uncertainty_above` (m^2) are left out; what is left of the light
/// when all others are blended is of the `background`.
struct View {
  ImageSize size;
  const gpu::Array<glsl::CameraState>& camera;
  const gpu::Array<float>& sensor_depth;
  float uncertainty_above = std::numeric_limits<float>::infinity();
  Eigen::Vector3f background = Eigen::Vector3f::Zero();  ///< RGB, 0 to 1
  bool same_lists = false;  ///< the tile lists at hand are used again (TileLists::serve())
};

/// L_iso (paper eq. 17): its weight, and the ratio of the largest scale to the smallest that is free.
struct IsotropyTerm {
  float weight = 0;
  float epsilon = 1;
};

/// Which outputs a forward pass computes: colour, opacity and D_alpha always; with Geometry the median depth
/// and the uncertainty too; All: also the dominators and their weights.
enum class Outputs { ColourDepth, Geometry, All };

/// The differentiable renderer (paper sections 3.1 and 3.2): tile lists, blending forward, and backward to
/// every parameter or to the pose alone. Everything is recorded; nothing is read back.
class Rasteriser {
 public:
  explicit Rasteriser(gpu::Device& device);
  Rasteriser(gpu::Device& device, const TileShape& shape);

  /// Renders the map into the images below.
  void record_forward(gpu::Recorder& recorder, const GaussianMap& map, const View& view, Outputs outputs);

  /// The second half of record_forward(): blends the splats of `lists`, which the caller has recorded and may
  /// have changed.
  void record_blending(gpu::Recorder& recorder, const View& view, Outputs outputs);

  /// After record_forward() of the same view with Outputs::Geometry, and with pixel_upstream filled:
  /// gradients of every visible Gaussian and of the pose. `isotropy` adds that of w L_iso (paper eq. 17).
  void record_backward(gpu::Recorder& recorder, GaussianMap& map, const View& view, PoseGradientKind kind,
                       const IsotropyTerm& isotropy);

  /// After record_forward() of the same view and `outputs`, with pixel_upstream filled: the gradient of the
  /// pose alone; nothing is written per Gaussian. Gradients of outputs that were not computed are left out.
  void record_backward_pose(gpu::Recorder& recorder, const GaussianMap& map, const View& view,
                            PoseGradientKind kind, Outputs outputs = Outputs::All);

  /// Renders one camera and reads everything back. `sensor_depth` (metres, row-major) may be empty: no
  /// uncertainty.
  RenderImages render(const GaussianMap& map, const Camera& camera, std::span<const float> sensor_depth = {},
                      const Eigen::Vector3f& background = Eigen::Vector3f::Zero());

  TileLists lists;

  // Images of the last view, row-major.
  gpu::Array<glsl::vec4> colour_opacity;  ///< I (RGB), O
  gpu::Array<glsl::vec4> geometry;        ///< D_alpha, D_median, U, the dominator's weight
  gpu::Array<glsl::uint> dominators;      ///< index in the map; 0xFFFFFFFF where nothing was blended
  gpu::Array<glsl::PixelUpstream>
      pixel_upstream;  ///< the caller's: dL/d(images), from lib/pixel_upstream.glsl

  // Gradients of the last backward pass; entries of Gaussians that were not visible are stale.
  gpu::Array<glsl::GaussianGradient> gaussian_gradients;
  gpu::Array<glsl::vec3> sh_gradients;
  gpu::Array<glsl::PoseGradient> pose_gradient;  ///< 1

 private:
  struct BackwardPasses;
  BackwardPasses& backward_passes(const GaussianMap& map, PoseGradientKind kind);

  gpu::Device& device_;
  gpu::Pass<passes::blend_forward> forward_;
  gpu::Pass<passes::blend_forward> forward_geometry_;
  gpu::Pass<passes::blend_forward> forward_all_;
  gpu::Pass<passes::blend_backward> backward_;
  gpu::Pass<passes::reduce_pose> reduce_pose_;
  struct BackwardPasses {
    gpu::Pass<passes::blend_backward_pose> blend_pose;
    gpu::Pass<passes::blend_backward_pose> blend_pose_all;
    gpu::Pass<passes::project_backward> project;
  };
  /// Per SH degree, kind of the pose's gradient and depth model, made when first needed.
  std::unique_ptr<BackwardPasses> backward_passes_[4][2][2];

  gpu::Array<glsl::FootprintGradient> footprint_gradients_;  ///< per instance, as the next
  gpu::Array<glsl::LayerGradient> layer_gradients_;
  gpu::Array<glsl::PoseGradient> pose_partials_;
  gpu::Array<glsl::CameraState> render_camera_;  ///< of render(), as the next
  gpu::Array<float> render_depth_;
};

}  // namespace surefield
