#pragma once

#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <vector>

#include "engine/gpu/pass.h"
#include "engine/gpu/recorder.h"
#include "engine/synth/scene.h"
#include "engine/types/camera.h"
#include "shaders/shared/cast_scene.h"

namespace surefield {

/// A camera that may move while it takes its images.
struct Exposure {
  Intrinsics intrinsics;
  std::vector<Pose> depth_poses{Pose::Identity()};  ///< world to camera, evenly spaced in time from the first
                                                    ///< row to the last; one: all rows at once
  std::vector<Pose>
      colour_poses;     ///< evenly spaced in time from the first row's opening to the last's closing
  double readout = 0;   ///< from row to row in all, as part of that time
  double exposure = 0;  ///< of one row, likewise
  int samples = 4;      ///< of colour, a pixel; a multiple of 4
  double brightness = 1;
  uint32_t seed = 0;           ///< of the times of the samples
  double visitor_seconds = 0;  ///< where the moving object is; see SceneRenderer
};

/// The images that an ideal camera takes.
struct SceneImages {
  cv::Mat colour;  ///< CV_8UC3, RGB
  cv::Mat depth;   ///< CV_32FC1, exact camera z at the pixel centres, metres; 0 where nothing is hit
  cv::Mat shapes;  ///< CV_32SC1, index of the body at the pixel centre, -1 where nothing is hit
};

/// Casts rays into a scene on a Vulkan device. May be used from several threads.
class SceneRenderer {
 public:
  /// `with_visitor` puts the scene's moving object in. Throws gpu::Error, or InputError for a scene of more
  /// bodies than the kernel takes.
  SceneRenderer(gpu::Device& device, const Scene& scene, bool with_visitor = false);

  SceneImages render(const Exposure& exposure) const;
  /// A camera that stands still.
  SceneImages render(const Camera& camera) const;

 private:
  void place_visitor(double seconds) const;

  gpu::Device& device_;
  gpu::Pass<passes::cast_scene> pass_;
  std::vector<Shape> visitor_;
  MovingObject visitor_motion_;
  uint32_t still_shapes_ = 0;
  uint32_t first_round_ = 0;  ///< shapes before this one are boxes, which are cast faster
  uint32_t lights_count_ = 0;
  gpu::Array<glsl::SceneSurface> surfaces_;
  gpu::Array<glsl::SceneMaterial> materials_;
  gpu::Array<glsl::SceneLight> lights_;
  gpu::Array<glsl::uvec2> light_cells_;
  gpu::Array<glsl::LightEntry> light_entries_;
  mutable std::mutex mutex_;  ///< guards what follows
  mutable gpu::Array<glsl::SceneShape> shapes_;
  mutable gpu::Array<glsl::CastPose> poses_;
  mutable gpu::Array<glsl::uint> colour_, hit_shapes_;
  mutable gpu::Array<float> depth_;
};

}  // namespace surefield
