#pragma once

#include <optional>
#include <string>

#include "engine/types/gaussian_cloud.h"
#include "engine/types/render_images.h"
#include "engine/viewer/viewer_scene.h"

namespace surefield {

/// The surface of a map under a pixel of a view.
struct Pick {
  Eigen::Vector2i pixel = Eigen::Vector2i::Zero();   ///< column and row
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< on the pixel's ray at `depth`; world, metres
  double depth = 0;                                  ///< the median depth, along the view's axis, metres
  std::optional<double> sigma;                       ///< standard deviation of the depth there, metres
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface, to the viewer; world, unit length
  int gaussian = 0;  ///< the one of the largest weight, which gives the two above
};

/// What a view's images (of the whole map, by `camera`) have at a pixel; nullopt outside of them and where
/// less than half of the light is stopped. `map` is the one that was rendered.
std::optional<Pick> pick(const RenderImages& images, const Camera& camera, const GaussianCloud& map,
                         const Eigen::Vector2i& pixel);

/// A keyframe that has to do with a place of the picture.
struct PickedKeyframe {
  int index = 0;         ///< in the scene's keyframes
  bool pointed = false;  ///< its frustum is under the cursor; else it has seen the surface there from nearest
};

/// The keyframe whose frustum, as lines_of() draws it, comes within `reach` pixels of a place of the picture,
/// the nearest to the camera, where the surface there does not hide it; else the one that stood nearest to
/// the surface of those that had it in their image. nullopt where there is none; `surface` may be empty.
std::optional<PickedKeyframe> keyframe_under(const ViewerScene& scene, const OverlayChoice& choice,
                                             const Camera& camera, const std::optional<Pick>& surface,
                                             const Eigen::Vector2d& place, double reach);

/// All that is known of a place of the picture.
struct Under {
  std::optional<Pick> surface;
  std::optional<PickedKeyframe> keyframe;
};

/// That as one line for programs, "point=x,y,z depth=..." with metres: fields of what is not known are left
/// out, and it is "nothing" where all are.
std::string describe(const Under& under);

/// The same for people, some short lines; `keyframes` are those of the scene, `first` is the time of its
/// first frame.
std::vector<std::string> tell(const Under& under, const Trajectory& keyframes, double first);

/// A distance between two places of the map as such a line.
std::string describe_distance(const Pick& from, const Pick& to);

/// Adds a small cross at a picked place, `pixels` wide in the view of `camera`.
void add_mark(std::vector<Line>& lines, const Pick& pick, const Camera& camera, double pixels);

/// Adds the surface's normal at a picked place, `pixels` long as it would be across the view in which it was
/// picked.
void add_normal(std::vector<Line>& lines, const Pick& pick, const Camera& camera, double pixels);

/// Adds a ruler: its ends, and the straight line between them where there are two.
void add_ruler(std::vector<Line>& lines, std::span<const Pick> ends, const Camera& camera);

}  // namespace surefield
