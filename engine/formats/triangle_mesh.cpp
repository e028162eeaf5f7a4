#include "engine/formats/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "engine/formats/ply_records.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

using Path = std::filesystem::path;

/// Three properties of the vertices, for example x y z; nullopt where one is missing.
std::optional<std::array<std::size_t, 3>> find_triple(const PlyElement& vertices,
                                                      const std::array<const char*, 3>& names) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto found = vertices.find(names[i]);
    if (!found) return std::nullopt;
    columns[i] = *found;
  }
  return columns;
}

void read_vertices(const Path& file, const PlyElement& element, PlyRecordReader& reader, TriangleMesh& mesh) {
  const auto position = find_triple(element, {"x", "y", "z"});
  if (!position) throw InputError(file, "its vertices have no properties x, y and z");
  const auto colour = find_triple(element, {"red", "green", "blue"});
  PlyRecord record;
  const auto triple = [&](const std::array<std::size_t, 3>& columns) {
    return Eigen::Vector3d(record.values[columns[0]], record.values[columns[1]], record.values[columns[2]]);
  };
  for (std::size_t i = 0; i < element.count; ++i) {
    reader.next(element, record);
    mesh.vertices.push_back(triple(*position).cast<float>());
    if (!mesh.vertices.back().allFinite()) {
      throw InputError(file, "its vertex " + std::to_string(i) + " is not finite; clean the mesh first");
    }
    if (colour) mesh.colours.push_back((triple(*colour) / 255.0).cast<float>());
  }
}

uint32_t vertex_index(const Path& file, double value, std::size_t vertices) {
  if (value >= 0 && value < static_cast<double>(vertices) && value == std::floor(value)) {
    return static_cast<uint32_t>(value);
  }
  throw InputError(file, "a face names a vertex that does not exist (there are " + std::to_string(vertices) +
                             "); the file is damaged");
}

void read_faces(const Path& file, const PlyElement& element, PlyRecordReader& reader, TriangleMesh& mesh) {
  auto list = element.find("vertex_indices");
  if (!list) list = element.find("vertex_index");
  if (!list || !element.properties[*list].list_length) {
    throw InputError(file, "its faces have no list vertex_indices; is it a triangle mesh?");
  }
  PlyRecord record;
  for (std::size_t i = 0; i < element.count; ++i) {
    reader.next(element, record);
    const auto corners = record.property(*list);
    const auto index = [&](std::size_t k) { return vertex_index(file, corners[k], mesh.vertices.size()); };
    for (std::size_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.push_back({index(0), index(k - 1), index(k)});
    }
  }
}

/// Turns a mesh back that its file has turned upright.
void turn_back(const Path& file, const PlyHeader& header, TriangleMesh& mesh) {
  for (const std::string& comment : header.comments) {
    const auto turn = read_turn_comment(file, comment);
    if (!turn) continue;
    const Eigen::Matrix3d file_to_world = turn->world_to_file.transpose();
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = (file_to_world * vertex.cast<double>()).cast<float>();
    mesh.up = turn->up();
    return;
  }
}

/// Positions, normals and colours as stored.
std::string vertex_bytes(const TriangleMesh& mesh) {
  const std::vector<Eigen::Vector3f> normals = vertex_normals(mesh);
  std::string bytes;
  bytes.reserve(mesh.vertices.size() * 27);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (const Eigen::Vector3f& vector : {mesh.vertices[i], normals[i]}) {
      char numbers[12];
      std::memcpy(numbers, vector.data(), sizeof(numbers));
      bytes.append(numbers, sizeof(numbers));
    }
    if (mesh.colours.empty()) continue;
    for (float value : mesh.colours[i]) {
      const float level = std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f) * 255.0f;
      bytes.push_back(static_cast<char>(static_cast<uint8_t>(std::lround(level))));
    }
  }
  return bytes;
}

std::string face_bytes(const TriangleMesh& mesh) {
  std::string bytes;
  bytes.reserve(mesh.triangles.size() * 13);
  for (const auto& triangle : mesh.triangles) {
    char corners[12];
    std::memcpy(corners, triangle.data(), sizeof(corners));
    bytes.push_back(3);
    bytes.append(corners, sizeof(corners));
  }
  return bytes;
}

}  // namespace

void check_mesh(const TriangleMesh& mesh) {
  if (!mesh.colours.empty() && mesh.colours.size() != mesh.vertices.size()) {
    throw UsageError("the mesh has more or fewer colours than vertices");
  }
  if (mesh.vertices.size() > static_cast<std::size_t>(std::numeric_limits<int32_t>::max())) {
    throw UsageError("more vertices than the indices of a PLY file can tell apart");
  }
}

std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
    // Twice the area long.
    const Eigen::Vector3f normal = (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
    for (uint32_t corner : triangle) normals[corner] += normal;
  }
  for (Eigen::Vector3f& normal : normals)
    if (normal.norm() > 0) normal = normal.stableNormalized().eval();
  return normals;
}

TriangleMesh read_mesh(const Path& file) {
  const PlyHeader header = read_ply_header(file);
  if (header.is_compressed()) throw InputError(file, "is a compressed map of Gaussians, no triangle mesh");
  PlyRecordReader reader(file, header);
  TriangleMesh mesh;
  read_vertices(file, header.vertices(), reader, mesh);
  PlyRecord record;
  for (std::size_t e = 1; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    if (element.name == "face") {
      read_faces(file, element, reader, mesh);
      turn_back(file, header, mesh);
      return mesh;
    }
    for (std::size_t i = 0; i < element.count; ++i) reader.next(element, record);
  }
  throw InputError(file, "has no element face; is it a triangle mesh?");
}

MeshTurn turn_of(const TriangleMesh& mesh, MeshAxes axes) {
  if (axes == MeshAxes::World) return {};
  if (!mesh.up) throw UsageError("a mesh that does not know where up is cannot be turned upright");
  return {axes, upright_turn(*mesh.up, axes)};
}

TriangleMesh turned(const TriangleMesh& mesh, const MeshTurn& turn) {
  TriangleMesh result = mesh;
  if (turn.axes == MeshAxes::World) return result;
  for (Eigen::Vector3f& vertex : result.vertices)
    vertex = (turn.world_to_file * vertex.cast<double>()).cast<float>();
  return result;
}

void write_mesh(const Path& file, const TriangleMesh& world_mesh, MeshAxes axes) {
  check_mesh(world_mesh);
  const MeshTurn turn = turn_of(world_mesh, axes);
  const TriangleMesh mesh = turned(world_mesh, turn);
  write_file(file, [&](std::ostream& stream) {
    stream << "ply\nformat binary_little_endian 1.0\n";
    if (axes != MeshAxes::World)
      stream << "comment " << kTurnNote << "\ncomment " << turn_comment(turn) << "\n";
    stream << "element vertex " << mesh.vertices.size()
           << "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float "
              "ny\nproperty "
              "float nz\n";
    if (!mesh.colours.empty()) stream << "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    stream << "element face " << mesh.triangles.size()
           << "\nproperty list uchar int vertex_indices\nend_header\n";
    stream << vertex_bytes(mesh) << face_bytes(mesh);
  });
}

}  // namespace surefield
