#pragma once

#include <vector>

#include "engine/formats/triangle_mesh.h"
#include "engine/types/camera.h"

namespace surefield {

/// Depth of a mesh seen from a camera, metres along camera z, row-major; infinite where nothing is seen. Both
/// sides of a triangle are seen.
std::vector<float> render_mesh_depth(const TriangleMesh& mesh, const Camera& camera);

/// How the depth images of two meshes differ.
struct DepthDifference {
  double mean = 0;   ///< of the absolute difference, over the pixels that show both, metres; NaN without any
  double shown = 0;  ///< pixels that show both, of those that show the truth
};

/// The true mesh as cameras see it, and so what they see of any mesh in the same frame.
class MeshViews {
 public:
  /// Renders `truth` from each camera.
  MeshViews(const TriangleMesh& truth, const std::vector<Camera>& cameras);

  /// Whether any camera sees the point: it lies in the image, and not more than 3 cm behind what the truth
  /// shows there (in the farthest of the four pixels around).
  bool sees(const Eigen::Vector3d& point) const;

  /// The part of a mesh that any camera sees. Triangles are cut until no side is longer than 2.5 cm, and
  /// those whose centre is seen are kept. Colours are left out.
  TriangleMesh visible_part(const TriangleMesh& mesh) const;

  /// Compares the depth of a mesh with that of the truth, in all views.
  DepthDifference compare_depth(const TriangleMesh& mesh) const;

 private:
  struct View {
    Camera camera;
    std::vector<float> depth;
  };

  static bool sees(const View& view, const Eigen::Vector3d& point);

  std::vector<View> views_;
};

}  // namespace surefield
