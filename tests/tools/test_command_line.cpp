// What the program says and returns without a device.
#include "tests/tools/support.h"

using namespace surefield::test;

namespace {

/// Runs the program with arguments that it must refuse: exit code 2, nothing on stdout, one line on stderr,
/// which is returned.
std::string refusal(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const Outcome outcome = surefield_command(arguments, folder.path());
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.starts_with("surefield: error: "));
  CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
  return outcome.err;
}

}  // namespace

TEST_CASE("help teaches every subcommand with an example") {
  const TemporaryFolder folder;
  const Outcome help = surefield_command({"--help"}, folder.path());
  CHECK(help.code == 0);
  for (const char* name : {"run", "eval", "report", "tables", "inspect", "fetch", "render", "export", "bench",
                           "basin", "graph", "devices"}) {
    CAPTURE(name);
    CHECK(contains(help.out, std::string("\n  ") + name + " "));
    const Outcome own = surefield_command({name, "--help"}, folder.path());
    CHECK(own.code == 0);
    CHECK(contains(own.out, "Example"));
    CHECK(contains(own.out, std::string("surefield ") + name));
  }
  const Outcome version = surefield_command({"--version"}, folder.path());
  CHECK(version.code == 0);
  CHECK(version.out.starts_with("surefield 0."));
}

TEST_CASE("wrong use ends with one line and exit code 2") {
  CHECK(contains(refusal({}), "subcommand is required; see surefield --help"));
  CHECK(contains(refusal({"walk"}), "there is no subcommand walk"));
  CHECK(contains(refusal({"run"}), "--out is required; see surefield run --help"));
  CHECK(
      contains(refusal({"run", "--out", "x"}), "--dataset or --live is required; see surefield run --help"));
  CHECK(contains(refusal({"run", "--dataset", "synthetic", "--out", "x", "--colour"}), "--colour"));
  CHECK(contains(refusal({"run", "--dataset", "synthetic", "--out", "x", "--frames", "many"}), "--frames"));
  CHECK(contains(refusal({"run", "--dataset", "synthetic", "--out", "x", "--format", "kitti"}), "kitti"));
  CHECK(contains(refusal({"run", "--dataset", "synthetic", "--out", "x", "--format", "tum"}), "--format"));
  CHECK(contains(refusal({"render", "--map", "m", "--camera", "c", "--out", "o", "--sensor-depth", "d"}),
                 "--depth-scale"));
}

TEST_CASE("wrong paths, folders and values are named") {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  CHECK(contains(refusal({"run", "--dataset", "/no/such", "--out", out}), "/no/such"));
  CHECK(contains(refusal({"run", "--dataset", folder.path().string(), "--out", out}), "folder"));
  const auto synthetic = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "--dataset", "synthetic", "--out", out});
    return refusal(more);
  };
  CHECK(contains(synthetic({"--set", "trackin.method=adam"}),
                 "unknown key trackin.method; did you mean tracking.method?"));
  CHECK(contains(synthetic({"--set", "tracking.renders=5"}),
                 "the key tracking.renders has been renamed; use gauss_newton.renders"));
  CHECK(contains(synthetic({"--set", "seed=1", "--set", "depth_max=far"}), "depth_max must be"));
  CHECK(contains(synthetic({"--config", "no.yaml"}), "no.yaml: no such file"));
  const auto config = folder.write("own.yaml", "base: synthetic.yaml\nmapping:\n  weight: 1\n");
  CHECK(contains(synthetic({"--config", config.string()}),
                 "own.yaml:3: unknown key mapping.weight; did you mean"));
  CHECK(contains(synthetic({"--frames", "-1"}), "frames"));
  CHECK(contains(synthetic({"--start", "1000"}), "1000"));
  CHECK(contains(synthetic({"--scale", "2"}), "scale"));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
  const auto file = folder.write("file", "");
  CHECK(contains(refusal({"run", "--dataset", "synthetic", "--out", (file / "out").string()}),
                 "cannot be created"));
}
