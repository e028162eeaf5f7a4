#include "engine/formats/triangle_mesh.h"
#include "engine/io/files.h"

#include "engine/formats/ply.h"
#include "engine/types/trajectory.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// The unit square at height z.
TriangleMesh square(float z) {
  return {{{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}, {}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Runs `surefield mesh`, with voxels so large that it is fast.
Outcome mesh_command(const TemporaryFolder& folder, std::vector<std::string> arguments,
                     const char* name = "mesh.ply") {
  arguments.insert(arguments.begin(), "mesh");
  arguments.insert(arguments.end(), {"--voxel", "0.06", "--truncation", "0.24", "--out", folder / name});
  return surefield_command(arguments, folder.path());
}

}  // namespace

TEST_CASE("mesh fuses what a run rendered, or its sensor saw, and eval compares the two") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);

  const Outcome rendered = mesh_command(folder, {"--run", folder / "out"});
  REQUIRE_MESSAGE(rendered.code == 0, rendered.err);
  CHECK(contains(rendered.out, "frames fused     3 of 3"));
  CHECK(contains(rendered.err, "3/3 frames fused"));
  CHECK(read_mesh(folder / "mesh.ply").triangles.size() > 100);
  CHECK(!read_mesh(folder / "mesh.ply").colours.empty());
  std::filesystem::rename(folder / "mesh.ply", folder / "rendered.ply");

  const Outcome sensor =
      mesh_command(folder, {"--run", folder / "out", "--source", "sensor", "--stride", "2"}, "sensor.glb");
  REQUIRE_MESSAGE(sensor.code == 0, sensor.err);
  CHECK(read_file(folder / "sensor.glb").starts_with("glTF"));
  CHECK(contains(sensor.out, "frames fused     2 of 2"));

  // In the dataset's own frame, and of its other frames, too.
  const Outcome truth = mesh_command(
      folder, {"--run", folder / "out", "--source", "sensor", "--trajectory", "true", "--stride", "20"});
  REQUIRE_MESSAGE(truth.code == 0, truth.err);

  const Outcome outcome = surefield_command(
      {"eval", "--run", folder / "out", "--mesh", folder / "rendered.ply", "--map", folder / "out/map.ply",
       "--ground-truth-mesh", folder / "mesh.ply", "--json", folder / "out.json"},
      folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "nearest triangle accuracy"));
  const nlohmann::json json = read_json(folder / "out.json");
  CHECK(json["schema"] == "surefield-mesh");
  CHECK(json["cameras"] > 2);
  CHECK(json["mesh"]["nearest_triangle"]["accuracy_m"] < json["mesh"]["point_to_point"]["accuracy_m"]);
  CHECK(json["mesh"]["depth_shown"] > 0.1);
  CHECK(json["gaussians"]["centres"] > 100);
}

TEST_CASE("eval measures the distance of two squares, without a dataset") {
  const TemporaryFolder folder;
  write_mesh(folder / "a.ply", square(0.2f));
  write_mesh(folder / "b.ply", square(0));
  const Outcome outcome = surefield_command({"eval", "--mesh", folder / "a.ply", "--ground-truth-mesh",
                                             folder / "b.ply", "--json", folder / "out.json"},
                                            folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "nothing is culled"));
  CHECK(contains(outcome.out, "nearest triangle accuracy 20.000 cm, completion 20.000 cm"));
  const nlohmann::json json = read_json(folder / "out.json");
  CHECK(json["mesh"]["nearest_triangle"]["accuracy_m"].get<double>() == doctest::Approx(0.2));
  CHECK(json["mesh"]["nearest_triangle"]["f1_1cm"] == 0);
  CHECK(json["mesh"]["depth_l1_m"].is_null());
  CHECK_FALSE(json.contains("gaussians"));
}

TEST_CASE("mesh and the comparison of meshes name what they lack") {
  const TemporaryFolder folder;
  const auto message = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = mesh_command(folder, arguments);
    CHECK(outcome.code == 2);
    CHECK_FALSE(std::filesystem::exists(folder / "mesh.ply"));
    return outcome.err;
  };
  CHECK(contains(message({}), "give --run, or --source sensor"));
  CHECK(contains(message({"--source", "sensor"}), "needs --dataset and --trajectory"));
  CHECK(contains(message({"--run", "/no/such"}), "/no/such/metrics.json: no such file"));
  CHECK(contains(message({"--run", "/no/such", "--trajectory", "true"}), "world frame of its own"));
  CHECK(contains(message({"--source", "other"}), "--source"));
  CHECK(contains(mesh_command(folder, {"--run", "/no/such"}, "a.off").err, "a.off: has no ending of a mesh"));
  CHECK(contains(message({"--run", "/no/such", "--stride", "0"}), "--stride"));

  write_mesh(folder / "a.ply", square(0));
  const Outcome nothing = surefield_command({"eval", "--ground-truth-mesh", folder / "a.ply"}, folder.path());
  CHECK(nothing.code == 2);
  CHECK(contains(nothing.err, "give --mesh, --map or both"));
}
