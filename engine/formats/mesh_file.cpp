#include "engine/formats/mesh_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <bit>
#include <cstring>
#include <limits>

#include "engine/formats/glb.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

static_assert(std::endian::native == std::endian::little,
              "STL files are written in the byte order of the machine");

namespace surefield {

namespace {

constexpr std::size_t kStlHeader = 80, kStlTriangle = 50;  // bytes

/// Vertices and normals are counted from 1, and a corner names both.
void write_obj(const std::filesystem::path& file, const TriangleMesh& world_mesh, const MeshTurn& turn) {
  const TriangleMesh mesh = turned(world_mesh, turn);
  const std::vector<Eigen::Vector3f> normals = vertex_normals(mesh);
  write_file(file, [&](std::ostream& stream) {
    stream << "# metres; colours, where there are any, stand behind the positions\n";
    if (turn.axes != MeshAxes::World) stream << "# " << kTurnNote << "\n# " << turn_comment(turn) << "\n";
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      stream << fmt::format("v {} {} {}", mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z());
      if (!mesh.colours.empty())
        stream << fmt::format(" {:.4g} {:.4g} {:.4g}", mesh.colours[i].x(), mesh.colours[i].y(),
                              mesh.colours[i].z());
      stream << "\n";
    }
    for (const Eigen::Vector3f& n : normals)
      stream << fmt::format("vn {:.4g} {:.4g} {:.4g}\n", n.x(), n.y(), n.z());
    for (const auto& [a, b, c] : mesh.triangles)
      stream << fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", a + 1, b + 1, c + 1);
  });
}

void write_stl(const std::filesystem::path& file, const TriangleMesh& world_mesh, const MeshTurn& turn) {
  const TriangleMesh mesh = turned(world_mesh, turn);
  if (mesh.triangles.size() > std::numeric_limits<uint32_t>::max())
    throw UsageError("write_mesh_file: more triangles than an STL file can count");
  write_file(file, [&](std::ostream& stream) {
    std::string header = "triangles, metres";
    if (turn.axes != MeshAxes::World) header += turn.axes == MeshAxes::YUp ? ", y up" : ", z up";
    header.resize(kStlHeader);
    const auto count = static_cast<uint32_t>(mesh.triangles.size());
    header.append(reinterpret_cast<const char*>(&count), sizeof(count));
    stream << header;
    for (const auto& triangle : mesh.triangles) {
      const Eigen::Vector3f &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                            &c = mesh.vertices[triangle[2]];
      char bytes[kStlTriangle] = {};
      std::size_t at = 0;
      for (const Eigen::Vector3f& v : {Eigen::Vector3f((b - a).cross(c - a).stableNormalized()), a, b, c}) {
        std::memcpy(bytes + at, v.data(), 3 * sizeof(float));
        at += 3 * sizeof(float);
      }
      stream.write(bytes, sizeof(bytes));
    }
  });
}

}  // namespace

void require_mesh_ending(const std::filesystem::path& file) {
  for (const char* ending : {".ply", ".obj", ".stl", ".glb"})
    if (file.extension() == ending) return;
  throw InputError(file, "has no ending of a mesh format; name it .ply, .obj, .stl or .glb");
}

void write_mesh_file(const std::filesystem::path& file, const TriangleMesh& mesh, MeshAxes axes) {
  require_mesh_ending(file);
  check_mesh(mesh);
  const MeshTurn turn = turn_of(mesh, axes);
  if (file.extension() == ".obj") return write_obj(file, mesh, turn);
  if (file.extension() == ".stl") return write_stl(file, mesh, turn);
  if (file.extension() == ".glb") return write_glb(file, mesh, turn);
  write_mesh(file, mesh, axes);
}

}  // namespace surefield
