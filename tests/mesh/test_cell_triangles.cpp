#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "engine/mesh/cell_triangles.h"
#include "engine/mesh/surface_builder.h"

using namespace surefield;

namespace {

/// How often each directed edge of the mesh occurs.
std::map<std::pair<uint32_t, uint32_t>, int> directed_edges(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  return edges;
}

/// The mesh of a field that is given at the corners of a lattice of `n` cells a side.
template <typename Field>
TriangleMesh mesh_of(int n, Field field) {
  SurfaceBuilder builder(1);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        std::array<CellCorner, kCellCorners> corners;
        for (int i = 0; i < kCellCorners; ++i) {
          const Eigen::Vector3i at(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2 & 1));
          corners[static_cast<std::size_t>(i)].distance = field(at);
        }
        builder.add_cell({x, y, z}, corners);
      }
  return builder.take();
}

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](std::size_t k) { return mesh.vertices[t[k]].cast<double>().eval(); };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return volume;
}

}  // namespace

TEST_CASE("cells of one corner, one edge and one face inside have the surfaces that geometry asks for") {
  CHECK(cell_triangles(0).empty());
  CHECK(cell_triangles(255).empty());
  CHECK(cell_triangles(0b00000001).size() == 1);
  CHECK(cell_triangles(0b00000011).size() == 2);
  CHECK(cell_triangles(0b00001111).size() == 2);
  // Corners 1 and 2 lie diagonally on a face: they are kept apart.
  CHECK(cell_triangles(0b00000110).size() == 2);
}

TEST_CASE("every crossed edge of every cell is used, and no other") {
  for (int inside = 0; inside < 256; ++inside) {
    std::set<int> used;
    for (const auto& t : cell_triangles(static_cast<uint8_t>(inside))) used.insert(t.begin(), t.end());
    for (int e = 0; e < 12; ++e) {
      const CellEdge& edge = cell_edges()[static_cast<std::size_t>(e)];
      const bool crossed = (inside >> edge.from & 1) != (inside >> edge.to & 1);
      CHECK(used.contains(e) == crossed);
    }
  }
}

TEST_CASE("surfaces of arbitrary fields are closed: neighbouring cells fit, whatever their ambiguities") {
  constexpr int kCells = 12;
  const TriangleMesh mesh = mesh_of(kCells, [&](const Eigen::Vector3i& at) {
    if (at.minCoeff() == 0 || at.maxCoeff() == kCells) return 1.0f;
    // A hash, since each corner is asked for by eight cells.
    auto h = static_cast<uint32_t>(at.x() * 73856093 ^ at.y() * 19349663 ^ at.z() * 83492791);
    h = (h ^ h >> 15) * 2246822519u;
    return (h >> 13 & 1) ? 1.0f : -1.0f;
  });
  CHECK(mesh.triangles.size() > 1000);
  const auto edges = directed_edges(mesh);
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    CHECK((back != edges.end() && back->second == count));
  }
}

TEST_CASE("a sphere is closed, each edge belongs to two triangles, and its outside is counter-clockwise") {
  constexpr double kRadius = 7.3;
  const Eigen::Vector3d centre(10.2, 9.9, 10.4);
  const TriangleMesh mesh = mesh_of(20, [&](const Eigen::Vector3i& at) {
    return static_cast<float>((at.cast<double>() - centre).norm() - kRadius);
  });
  const auto edges = directed_edges(mesh);
  for (const auto& [edge, count] : edges) {
    CHECK(count == 1);
    CHECK(edges.contains({edge.second, edge.first}));
  }
  const double expected = 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3);
  CHECK(signed_volume(mesh) == doctest::Approx(expected).epsilon(0.02));
  for (const auto& vertex : mesh.vertices) {
    CHECK((vertex.cast<double>() - centre).norm() == doctest::Approx(kRadius).epsilon(0.01));
  }
  // Euler: a sphere has as many vertices as half its triangles, and two more.
  CHECK(mesh.vertices.size() == mesh.triangles.size() / 2 + 2);
}

TEST_CASE("vertices lie where the field is zero, with the colour between those of the corners") {
  SurfaceBuilder builder(0.5);
  std::array<CellCorner, kCellCorners> corners;
  for (int i = 0; i < kCellCorners; ++i) {
    auto& corner = corners[static_cast<std::size_t>(i)];
    corner.distance = i & 1 ? 3.0f : -1.0f;
    corner.colour = i & 1 ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 0, 1);
  }
  builder.add_cell({-4, 0, 2}, corners);
  const TriangleMesh mesh = builder.take();
  REQUIRE(mesh.vertices.size() == 4);
  REQUIRE(mesh.triangles.size() == 2);
  for (const auto& vertex : mesh.vertices) {
    CHECK(vertex.x() == doctest::Approx(0.5 * (-4 + 0.25)));
    CHECK(vertex.z() >= 1.0f);
    CHECK(vertex.z() <= 1.5f);
  }
  for (const auto& colour : mesh.colours) CHECK((colour - Eigen::Vector3f(0.25f, 0, 0.75f)).norm() < 1e-6f);
}
