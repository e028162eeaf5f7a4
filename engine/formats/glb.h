#pragma once

#include <filesystem>

#include "engine/formats/triangle_mesh.h"
#include "engine/types/gaussian_cloud.h"

namespace surefield {

/// Writes Gaussians as binary glTF 2.0 with the extension KHR_gaussian_splatting (docs/formats.md): nothing
/// is rounded but the colours of the points that programs without the extension show. The axes are glTF's:
/// right, up and back of the run's first camera. Gaussians that are not finite, and the uncertainty, are left
/// out. The file appears complete or not at all. Throws InputError when it cannot be written or would be
/// larger than the 4 GiB that the format allows.
void write_glb(const std::filesystem::path& file, const GaussianCloud& cloud);

/// Writes a triangle mesh as binary glTF 2.0, in the same axes. Where it has colours, they are shown as they
/// are, without light. Where `turn` has y upwards, the node turns the mesh, and its extras say how. Otherwise
/// as above. Throws InputError where z is up, which glTF does not have.
void write_glb(const std::filesystem::path& file, const TriangleMesh& mesh, const MeshTurn& turn = {});

}  // namespace surefield
