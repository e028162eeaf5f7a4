// surefield convert.
#include "engine/io/files.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

TEST_CASE("a run on what convert has written, there and back, is the run on the source") {
  const TemporaryFolder folder;
  const auto command = [&](std::vector<std::string> arguments) {
    const Outcome outcome = surefield_command(std::move(arguments), folder.path());
    REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
    return outcome.out;
  };
  command({"synth", "--frames", "3", "--size", "64x48", "--layout", "tum", "--out", folder / "source"});
  const std::string said =
      command({"convert", folder / "source", "--to", "mcap", "--out", folder / "log.mcap"});
  CHECK(contains(said, "3 frames, mcap, with true poses"));
  command({"convert", folder / "log.mcap", "--to", "tum", "--depth-unit", "0.0002", "--out", folder / "tum"});
  command({"convert", folder / "tum", "--to", "plain", "--frames", "2", "--out", folder / "plain"});
  const auto trajectory = [&](const std::string& dataset) {
    command({"run", "--dataset", folder / dataset, "--out", folder / ("out_" + dataset), "--frames", "2",
             "--depth-delay", "0", "--set", "first_iterations=3", "--set", "mapping_iterations=2"});
    return read_file(folder / ("out_" + dataset + "/trajectory.txt"));
  };
  const std::string expected = trajectory("source");
  CHECK(trajectory("log.mcap") == expected);
  CHECK(trajectory("tum") == expected);
  CHECK(trajectory("plain") == expected);
}

TEST_CASE("convert says what does not go") {
  const TemporaryFolder folder;
  const auto error = [&](std::vector<std::string> arguments) {
    const Outcome outcome = surefield_command(std::move(arguments), folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  REQUIRE(surefield_command(
              {"synth", "--frames", "2", "--size", "64x48", "--layout", "tum", "--out", folder / "source"},
              folder.path())
              .code == 0);
  CHECK(contains(error({"convert", folder / "source", "--to", "bag", "--out", folder / "a"}), "--to"));
  CHECK(contains(error({"convert", folder / "source", "--to", "tum", "--out", folder / "source"}),
                 "not empty"));
  CHECK(contains(error({"convert", folder / "source", "--to", "tum", "--start", "2", "--out", folder / "b"}),
                 "--start"));
  CHECK(contains(
      error({"convert", folder / "source", "--to", "tum", "--depth-unit", "0.001", "--out", folder / "c"}),
      "--lossy"));
}
