#pragma once

#include <filesystem>

#include "engine/formats/triangle_mesh.h"

namespace surefield {

/// Throws InputError where the file's ending is none of .ply, .obj, .stl and .glb.
void require_mesh_ending(const std::filesystem::path& file);

/// Writes a mesh in the format that the file's ending names: PLY (write_mesh()), Wavefront OBJ (text; colours
/// behind the positions, normals), binary STL (no colours), or binary glTF (write_glb()). All but glTF are in
/// the mesh's own frame. The file appears complete or not at all. Throws InputError when it cannot be
/// written.
void write_mesh_file(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace surefield
