#include <cmath>

#include "engine/io/files.h"
#include "engine/io/map_file.h"
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

TEST_CASE("export refuses what it cannot write or read with the reason") {
  const TemporaryFolder folder;
  write_map(folder / "map.ply", one_gaussian());
  const auto message = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "export");
    const Outcome outcome = surefield_command(arguments, folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(message({"--map", folder / "map.ply", "--out", folder / "a.jpg"}), "name it .ply or .spz"));
  CHECK(contains(message({"--map", folder / "no.spz", "--out", folder / "a.ply"}), "no.spz: no such file"));
  CHECK(contains(message({"--run", folder / "no", "--out", folder / "a.ply"}), "metrics.json: no such file"));
  CHECK(contains(message({"--out", folder / "a.ply"}), "see surefield export --help"));
}

TEST_CASE("a run stores its map compactly when asked to, and commands find it there") {
  const TemporaryFolder folder;
  folder.write("out/map.ply", "of an earlier run");
  std::vector<std::string> arguments = short_run(folder / "out");
  arguments.insert(arguments.end(), {"--map-format", "spz"});
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
