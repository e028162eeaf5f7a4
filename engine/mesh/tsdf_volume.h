#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "engine/formats/triangle_mesh.h"
#include "engine/types/camera.h"
#include "engine/types/depth_noise.h"

namespace surefield {

/// How finely depth is fused.
struct TsdfSettings {
  double voxel = 0.01;       ///< side of a voxel, metres
  double truncation = 0.04;  ///< distances are kept up to this far from the surface, metres; 2 voxels or more
};

/// A depth image with colours and where it was taken. Row-major, of the size of the camera's intrinsics.
struct DepthView {
  Camera camera;
  std::span<const float> depth;     ///< metres along camera z; invalid where not finite or not positive
  std::span<const float> colour;    ///< RGB, 0 to 1, 3 floats a pixel; empty: grey
  DepthNoise noise{.constant = 1};  ///< depths weigh 1 / sigma^2; as it is: all alike
};

/// The surface as a truncated signed distance field, averaged over depth images. It is stored only in blocks
/// of 8 x 8 x 8 voxels that lie within the truncation of some depth, so memory grows with the surface and not
/// with the volume. Uses all cores; the outcome does not depend on how many there are.
class TsdfVolume {
 public:
  /// Throws InputError when the settings are not possible.
  explicit TsdfVolume(const TsdfSettings& settings = {});
  ~TsdfVolume();
  TsdfVolume(const TsdfVolume&) = delete;
  TsdfVolume& operator=(const TsdfVolume&) = delete;

  /// Adds a view. A voxel is compared with the depth of the pixel that it falls on, along z. Within the
  /// truncation the difference is averaged, with the weight of the depth, which falls to zero behind the
  /// surface; a voxel in free space counts as outside, as far as there is a block for it. Throws UsageError
  /// when the images do not have the size of the intrinsics, or hold depths too far away for the voxels to be
  /// counted.
  void integrate(const DepthView& view);

  /// The surface: marching cubes over the cells whose 8 corners were all observed. Empty where nothing was
  /// integrated.
  TriangleMesh extract() const;

  /// Blocks in memory, and the bytes that they take.
  std::size_t blocks() const;
  std::size_t bytes() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace surefield
