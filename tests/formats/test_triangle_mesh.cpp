#include "engine/formats/triangle_mesh.h"

#include <limits>

#include "engine/io/files.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

using Triangle = std::array<uint32_t, 3>;

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1.5f, 0, 0}, {0, -2.25f, 0}, {0, 0, 0.1f}};
  mesh.colours = {{0, 0, 0}, {1, 0.2f, 0}, {0, 1, 0.4f}, {1, 1, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

constexpr const char* kAsciiMesh =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty uchar blue\nproperty uchar green\nproperty uchar red\n"
    "property double z\nproperty float quality\nproperty float y\nproperty float x\n"
    "element edge 1\nproperty int from\nproperty int to\n"
    "element face 3\nproperty uchar label\nproperty list uchar uint vertex_index\nend_header\n"
    "255 0 51 3 9 2 1\n0 0 0 3 9 2 5\n0 0 0 3 9 6 5\n0 0 0 3 9 6 1\n"
    "0 1\n"
    "7 4 0 1 2 3\n7 3 1 2 3\n7 2 0 1\n";

std::string read_error(const TemporaryFolder& folder, const std::string& content) {
  return input_error([&] { read_mesh(folder.write("mesh.ply", content)); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("a mesh survives: positions bit by bit, colours to 8 bits") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = tetrahedron();
  write_mesh(folder / "a.ply", mesh);
  const TriangleMesh read = read_mesh(folder / "a.ply");
  CHECK(read.vertices == mesh.vertices);
  CHECK(read.triangles == mesh.triangles);
  REQUIRE(read.colours.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK((read.colours[i] - mesh.colours[i]).norm() < 1e-6f);
  CHECK_FALSE(std::filesystem::exists(folder / "a.ply.part"));
}

TEST_CASE("a face that claims more corners than the file has bytes is refused before memory is taken") {
  const TemporaryFolder folder;
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
  bytes +=
      std::string(12, '\0') + std::string("\x00\x28\x6b\xee", 4) + std::string(400, '\0');  // 4 000 000 000
  CHECK(contains(read_error(folder, bytes), "ends or is damaged before its last face"));
}

TEST_CASE("meshes without colours and without anything survive") {
  const TemporaryFolder folder;
  TriangleMesh mesh = tetrahedron();
  mesh.colours.clear();
  write_mesh(folder / "a.ply", mesh);
  CHECK(read_mesh(folder / "a.ply").colours.empty());
  CHECK(read_mesh(folder / "a.ply").triangles == mesh.triangles);
  write_mesh(folder / "empty.ply", {});
  CHECK(read_mesh(folder / "empty.ply").vertices.empty());
  CHECK(read_mesh(folder / "empty.ply").triangles.empty());
}

TEST_CASE("colours beyond 0 to 1 are clamped when a mesh is written") {
  const TemporaryFolder folder;
  TriangleMesh mesh = tetrahedron();
  mesh.colours[0] = {-1, 2, std::numeric_limits<float>::quiet_NaN()};
  write_mesh(folder / "a.ply", mesh);
  CHECK(read_mesh(folder / "a.ply").colours[0] == Eigen::Vector3f(0, 1, 0));
}

TEST_CASE("properties of meshes may come in any order and type, polygons become fans, others are ignored") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("a.ply", kAsciiMesh));
  REQUIRE(mesh.vertices.size() == 4);
  CHECK(mesh.vertices[0] == Eigen::Vector3f(1, 2, 3));
  CHECK(mesh.vertices[2] == Eigen::Vector3f(5, 6, 3));
  CHECK((mesh.colours[0] - Eigen::Vector3f(0.2f, 0, 1)).norm() < 1e-6f);
  CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 2, 3}});
}

TEST_CASE("wrong meshes are refused with the reason") {
  const TemporaryFolder folder;
  const std::string good = kAsciiMesh;
  CHECK(read_error(folder, good).empty());
  CHECK(contains(read_error(folder, replaced(good, "float x", "float a")), "no properties x, y and z"));
  CHECK(contains(read_error(folder, replaced(good, "element face", "element fact")), "no element face"));
  CHECK(contains(read_error(folder, replaced(good, "vertex_index", "corners")), "no list vertex_indices"));
  CHECK(contains(read_error(folder, replaced(good, "list uchar uint", "uint")), "no list vertex_indices"));
  CHECK(
      contains(read_error(folder, replaced(good, "list uchar", "list u")), "mesh.ply:16: \"u\" is no type"));
  CHECK(contains(read_error(folder, replaced(good, "7 3 1 2 3", "7 3 1 2 4")), "vertex that does not exist"));
  CHECK(
      contains(read_error(folder, replaced(good, "7 3 1 2 3", "7 3 1 2 -1")), "vertex that does not exist"));
  CHECK(contains(read_error(folder, replaced(good, "7 3 1 2 3", "7 4 1 2 3")), "before its last face"));
  CHECK(contains(read_error(folder, replaced(good, "7 3 1 2 3", "7 3 1 2 3 0")), "before its last face"));
  CHECK(contains(read_error(folder, replaced(good, "7 3 1 2 3", "7 -3 1 2 3")), "before its last face"));
  CHECK(contains(read_error(folder, replaced(good, "9 2 1", "9 2 nan")), "vertex 0 is not finite"));
  CHECK(contains(input_error([&] { write_mesh(folder / "no/a.ply", {}); }), "create it first"));
}

TEST_CASE("a mesh cut at any byte, or with any byte changed, is read or refused, never a crash") {
  const TemporaryFolder folder;
  write_mesh(folder / "full.ply", tetrahedron());
  const std::string full = read_file(folder / "full.ply");
  for (std::size_t length = 0; length < full.size(); ++length) {
    CHECK_FALSE(read_error(folder, full.substr(0, length)).empty());
  }
  for (std::size_t i = 0; i < full.size(); ++i) {
    for (char c : {'\0', '9', '\n', '\xff'}) {
      std::string changed = full;
      changed[i] = c;
      const std::string message = read_error(folder, changed);
      CHECK((message.empty() || contains(message, "mesh.ply")));
    }
  }
}
