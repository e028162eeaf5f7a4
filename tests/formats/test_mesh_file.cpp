#include "engine/formats/mesh_file.h"

#include <Eigen/Geometry>
#include <cstring>
#include <sstream>

#include "engine/io/files.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

/// Two triangles of a square at z = 0, of which one has twice the corner, and a vertex that none has.
TriangleMesh square() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {5, 5, 5}};
  mesh.colours = {{0, 0, 0}, {1, 0.5f, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

std::vector<std::string> lines_of(const std::string& text, const std::string& start) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with(start + " ")) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("the normal of a vertex is that of its triangles, weighed by their areas") {
  TriangleMesh mesh = square();
  const std::vector<Eigen::Vector3f> flat = vertex_normals(mesh);
  for (int i = 0; i < 4; ++i) CHECK(flat[i].isApprox(Eigen::Vector3f::UnitZ()));
  CHECK(vertex_normals(mesh)[4].isZero());
  // Upright beside it, twice as large.
  mesh.vertices.push_back({0, 0, 4});
  mesh.triangles.push_back({0, 5, 1});
  CHECK(vertex_normals(mesh)[1].isApprox(Eigen::Vector3f(0, 2, 1).normalized(), 1e-5f));
  CHECK(vertex_normals({}).empty());
}

TEST_CASE("meshes are written as the ending names them") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = square();
  write_mesh_file(folder / "a.ply", mesh);
  CHECK(read_mesh(folder / "a.ply").vertices == mesh.vertices);
  CHECK(contains(read_file(folder / "a.ply"), "property float nz"));
  write_mesh_file(folder / "a.glb", mesh);
  CHECK(read_file(folder / "a.glb").starts_with("glTF"));

  write_mesh_file(folder / "a.obj", mesh);
  const std::string obj = read_file(folder / "a.obj");
  REQUIRE(lines_of(obj, "v").size() == 5);
  CHECK(lines_of(obj, "v")[1] == "v 2 0 0 1 0.5 0");
  CHECK(lines_of(obj, "vn")[0] == "vn 0 0 1");
  CHECK(lines_of(obj, "f") == std::vector<std::string>{"f 1//1 2//2 3//3", "f 1//1 3//3 4//4"});

  write_mesh_file(folder / "a.stl", mesh);
  const std::string stl = read_file(folder / "a.stl");
  REQUIRE(stl.size() == 84 + 2 * 50);
  uint32_t count = 0;
  std::memcpy(&count, stl.data() + 80, sizeof(count));
  CHECK(count == 2);
  float numbers[12];
  std::memcpy(numbers, stl.data() + 84 + 50, sizeof(numbers));
  CHECK(Eigen::Map<Eigen::Vector3f>(numbers).isApprox(Eigen::Vector3f::UnitZ()));
  CHECK(Eigen::Map<Eigen::Vector3f>(numbers + 6).isApprox(Eigen::Vector3f(2, 2, 0)));

  CHECK(contains(input_error([&] { write_mesh_file(folder / "a.off", mesh); }),
                 "name it .ply, .obj, .stl or .glb"));
  for (const char* name : {"empty.obj", "empty.stl", "empty.ply"}) write_mesh_file(folder / name, {});
  CHECK(read_file(folder / "empty.stl").size() == 84);
}
