#include "engine/formats/mesh_axes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "engine/formats/mesh_file.h"
#include "engine/io/files.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d(0.2, -0.9, -0.5).normalized();

/// A triangle with its normal along x.
TriangleMesh upright_triangle() {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}, {1, 3, 3}, {1, 2, 4}};
  mesh.triangles = {{0, 1, 2}};
  mesh.up = kUp;
  return mesh;
}

void check_same(const TriangleMesh& a, const TriangleMesh& b) {
  REQUIRE(a.vertices.size() == b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) CHECK(a.vertices[i].isApprox(b.vertices[i], 1e-6f));
}

/// The first part of a binary glTF file.
nlohmann::json json_of(const std::string& glb) {
  uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof(length));
  return nlohmann::json::parse(glb.substr(20, length));
}

}  // namespace

TEST_CASE("upright axes have up upwards and the first camera's view forward, and are right-handed") {
  const Eigen::Matrix3d y_up = upright_turn(kUp, MeshAxes::YUp), z_up = upright_turn(kUp, MeshAxes::ZUp);
  for (const Eigen::Matrix3d& turn : {y_up, z_up}) {
    CHECK((turn * turn.transpose()).isIdentity(1e-12));
    CHECK(turn.determinant() == doctest::Approx(1));
  }
  CHECK((y_up * kUp).isApprox(Eigen::Vector3d::UnitY()));
  CHECK((z_up * kUp).isApprox(Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d in_y = y_up * Eigen::Vector3d::UnitZ(), in_z = z_up * Eigen::Vector3d::UnitZ();
  CHECK(in_y.z() < -0.8);
  CHECK(std::abs(in_y.x()) < 1e-12);
  CHECK(in_z.y() > 0.8);
  CHECK(std::abs(in_z.x()) < 1e-12);
  // An upright camera's axes are glTF's but for the signs.
  CHECK(upright_turn(-Eigen::Vector3d::UnitY(), MeshAxes::YUp)
            .isApprox(Eigen::Vector3d(1, -1, -1).asDiagonal().toDenseMatrix()));
  // One that looks straight down.
  const Eigen::Matrix3d down = upright_turn(-Eigen::Vector3d::UnitZ(), MeshAxes::ZUp);
  CHECK((down * -Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitY()));
  CHECK(down.determinant() == doctest::Approx(1));
}

TEST_CASE("a PLY mesh says how it was turned, and is read in its world whatever its axes") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = upright_triangle();
  for (const MeshAxes axes : {MeshAxes::YUp, MeshAxes::ZUp}) {
    write_mesh_file(folder / "a.ply", mesh, axes);
    const TriangleMesh read = read_mesh(folder / "a.ply");
    check_same(read, mesh);
    REQUIRE(read.up);
    CHECK(read.up->isApprox(kUp, 1e-12));
  }
  // Without the comments, it is as it stands in the file.
  std::string bytes = read_file(folder / "a.ply");
  for (auto at = bytes.find("comment"); at != std::string::npos; at = bytes.find("comment"))
    bytes.erase(at, bytes.find('\n', at) + 1 - at);
  const TriangleMesh bare = read_mesh(folder.write("bare.ply", bytes));
  check_same(bare, turned(mesh, turn_of(mesh, MeshAxes::ZUp)));
  CHECK_FALSE(bare.up);
  CHECK((bare.vertices[0].z() == doctest::Approx(kUp.dot(Eigen::Vector3d(1, 2, 3)))));

  write_mesh_file(folder / "world.ply", mesh);
  CHECK_FALSE(contains(read_file(folder / "world.ply"), "comment"));
  CHECK(read_mesh(folder / "world.ply").vertices == mesh.vertices);
}

TEST_CASE("the other formats are turned as they say") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = upright_triangle();
  const Eigen::Matrix3d y_up = upright_turn(kUp, MeshAxes::YUp);
  const Eigen::Vector3d first = y_up * Eigen::Vector3d(1, 2, 3);
  write_mesh_file(folder / "a.obj", mesh, MeshAxes::YUp);
  const std::string obj = read_file(folder / "a.obj");
  CHECK(contains(obj, "# " + turn_comment({MeshAxes::YUp, y_up})));
  float x = 0, y = 0, z = 0;
  REQUIRE(std::sscanf(obj.c_str() + obj.find("\nv "), "\nv %f %f %f", &x, &y, &z) == 3);
  CHECK(Eigen::Vector3d(x, y, z).isApprox(first, 1e-5));
  write_mesh_file(folder / "a.stl", mesh, MeshAxes::ZUp);
  CHECK(read_file(folder / "a.stl").starts_with("triangles, metres, z up"));

  // The node turns what the accessor holds.
  write_mesh_file(folder / "a.glb", mesh, MeshAxes::YUp);
  const nlohmann::json node = json_of(read_file(folder / "a.glb"))["nodes"][0];
  const auto numbers = node["matrix"].get<std::vector<double>>();
  const Eigen::Map<const Eigen::Matrix4d> matrix(numbers.data());
  CHECK((matrix * Eigen::Vector4d(1, -2, -3, 1)).head<3>().isApprox(first, 1e-9));
  const auto rows = node["extras"]["world_to_file"].get<std::vector<double>>();
  CHECK(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data()).isApprox(y_up, 1e-12));
  write_mesh_file(folder / "world.glb", mesh);
  CHECK_FALSE(json_of(read_file(folder / "world.glb"))["nodes"][0].contains("matrix"));
}

TEST_CASE("meshes are not turned where nobody knows how, and comments that tell no rotation are refused") {
  const TemporaryFolder folder;
  TriangleMesh mesh = upright_triangle();
  CHECK(contains(input_error([&] { write_mesh_file(folder / "a.glb", mesh, MeshAxes::ZUp); }),
                 "in glTF, y is up"));
  mesh.up.reset();
  CHECK_THROWS_AS(write_mesh_file(folder / "a.ply", mesh, MeshAxes::ZUp), UsageError);
  CHECK_FALSE(read_turn_comment("a.ply", "made by hand"));
  for (const char* wrong : {"world_to_file", "world_to_file z 1 0 0 0 1 0 0 0",
                            "world_to_file x 1 0 0 0 1 0 0 0 1", "world_to_file z 2 0 0 0 1 0 0 0 1",
                            "world_to_file y 1 0 0 0 1 0 0 0 -1", "world_to_file y nan 0 0 0 1 0 0 0 1"}) {
    CAPTURE(wrong);
    CHECK(contains(input_error([&] { read_turn_comment("a.ply", wrong); }),
                   "a.ply: its comment world_to_file"));
  }
}
