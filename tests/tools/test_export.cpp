#include <cmath>

#include "engine/formats/map_file.h"
#include "engine/formats/triangle_mesh.h"
#include "engine/io/files.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

GaussianCloud one_gaussian() {
  GaussianCloud cloud;
  cloud.resize(1);
  cloud.means[0] = {1, 2, 3};
  cloud.log_scales[0] = {-4, -4.5f, -5};
  return cloud;
}

}  // namespace

TEST_CASE("export turns a map into another format and back, within the rounding of the format") {
  const TemporaryFolder folder;
  write_map(folder / "map.ply", one_gaussian());
  const Outcome there =
      surefield_command({"export", "--map", folder / "map.ply", "--out", folder / "map.spz"}, folder.path());
  CHECK_MESSAGE(there.code == 0, there.err);
  CHECK(contains(there.out, "1 Gaussians of SH degree 0"));
  CHECK(read_file(folder / "map.spz").starts_with("\x1f\x8b"));
  const Outcome back =
      surefield_command({"export", "--map", folder / "map.spz", "--out", folder / "back.ply"}, folder.path());
  CHECK_MESSAGE(back.code == 0, back.err);
  CHECK(read_map(folder / "back.ply").cloud.means[0].isApprox(Eigen::Vector3f(1, 2, 3), 1e-4f));
}

TEST_CASE("export writes the format that the ending or --format names, and meshes") {
  const TemporaryFolder folder;
  write_map(folder / "map.ply", one_gaussian());
  write_mesh(folder / "mesh.ply", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}});
  const auto start = [&](std::vector<std::string> arguments, const std::string& file) {
    arguments.insert(arguments.begin(), "export");
    arguments.insert(arguments.end(), {"--out", folder / file});
    const Outcome outcome = surefield_command(arguments, folder.path());
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    return read_file(folder / file);
  };
  const std::string map = folder / "map.ply";
  CHECK(contains(start({"--map", map}, "a.compressed.ply"), "element chunk 1"));
  CHECK(contains(start({"--map", map, "--format", "cply"}, "b.ply"), "element chunk 1"));
  CHECK(contains(start({"--map", folder / "b.ply"}, "c.ply"), "property float scale_0"));
  CHECK(contains(start({"--map", map, "--format", "points"}, "d.ply"), "property uchar red"));
  CHECK(contains(start({"--map", map}, "e.glb"), "KHR_gaussian_splatting:SCALE"));
  CHECK(start({"--mesh", folder / "mesh.ply"}, "f.glb").starts_with("glTF"));
  CHECK(start({"--mesh", folder / "mesh.ply"}, "f.obj").starts_with("# metres"));
  CHECK(start({"--mesh", folder / "mesh.ply"}, "f.stl").starts_with("triangles, metres"));
}

TEST_CASE("export refuses what it cannot write or read with the reason") {
  const TemporaryFolder folder;
  write_map(folder / "map.ply", one_gaussian());
  const auto message = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "export");
    const Outcome outcome = surefield_command(arguments, folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(message({"--map", folder / "map.ply", "--out", folder / "a.jpg"}), "name it .ply, .comp"));
  const auto as = [&](const char* format, const char* name) {
    return message({"--map", folder / "map.ply", "--format", format, "--out", folder / name});
  };
  CHECK(contains(as("spz", "a.ply"), "a.ply: is named like another format than --format spz; name it .spz"));
  CHECK(contains(as("points", "a.compressed.ply"), "--format points; name it .ply"));
  CHECK(contains(as("sog", "a.ply"), "sog not in {cply,glb,ply,points,spz}"));
  CHECK(contains(message({"--mesh", folder / "map.ply", "--out", folder / "a.off"}),
                 "name it .ply, .obj, .stl or .glb"));
  CHECK(contains(message({"--mesh", folder / "map.ply", "--out", folder / "a.glb"}),
                 "map.ply: has no element face"));
  CHECK(contains(message({"--map", folder / "no.spz", "--out", folder / "a.ply"}), "no.spz: no such file"));
  CHECK(contains(message({"--run", folder / "no", "--out", folder / "a.ply"}), "metrics.json: no such file"));
  CHECK(contains(message({"--out", folder / "a.ply"}), "see surefield export --help"));
}

TEST_CASE("a run stores its map compactly when asked to, and commands find it there") {
  const TemporaryFolder folder;
  folder.write("out/map.ply", "of an earlier run");
  std::vector<std::string> arguments = short_run(folder / "out");
  arguments.insert(arguments.end(), {"--map-format", "spz", "--overwrite"});
  const Outcome run = surefield_command(arguments, folder.path());
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK_FALSE(std::filesystem::exists(folder / "out/map.ply"));
  const Outcome outcome =
      surefield_command({"export", "--run", folder / "out", "--out", folder / "map.ply"}, folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(read_map(folder / "map.ply").cloud.size() ==
        read_json(folder / "out/metrics.json")["map"]["gaussians"]);
  CHECK(2 * std::filesystem::file_size(folder / "out/map.spz") <
        std::filesystem::file_size(folder / "map.ply"));
}
