#pragma once

#include <filesystem>

#include "engine/formats/triangle_mesh.h"

namespace surefield {

/// Throws InputError where the file's ending is none of .ply, .obj, .stl and .glb.
void require_mesh_ending(const std::filesystem::path& file);

/// Writes a mesh in the format that the file's ending names: PLY (write_mesh()), Wavefront OBJ (text; colours
/// behind the positions, normals), binary STL (no colours), or binary glTF (write_glb()). The file is in
/// `axes`; glTF in its own for MeshAxes::World. Upright ones are named in a comment, of glTF in the node's
/// extras. The file appears complete or not at all. Throws InputError when it cannot be written, and for glTF
/// with z up; UsageError where axes are upright and the mesh does not know where up is.
void write_mesh_file(const std::filesystem::path& file, const TriangleMesh& mesh,
                     MeshAxes axes = MeshAxes::World);

}  // namespace surefield
