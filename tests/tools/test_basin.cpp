#include <algorithm>

#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

TEST_CASE("basin finds that tracking comes back from near, and says how far it ends from far") {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = short_run(folder / "out", 2);
  std::replace(arguments.begin(), arguments.end(), std::string("0.2"), std::string("0.3"));
  arguments.insert(arguments.end(), {"--set", "first_iterations=60"});
  const Outcome run = surefield_command(arguments, folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const auto measure = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"basin", "--run", folder / "out", "--json", folder / "basin.json"});
    const Outcome outcome = surefield_command(more, folder.path());
    REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
    return outcome.out;
  };
  CHECK(contains(measure({}), "2 frames, each tracked from"));
  const nlohmann::json json = read_json(folder / "basin.json");
  CHECK(json["schema"] == "surefield-basin");
  CHECK(json["version"] == 1);
  CHECK(json["frames"] == 2);
  REQUIRE(json["starts"].size() == 18);
  const nlohmann::json &near = json["starts"][0], &adam_far = json["starts"][17];
  CHECK(near["method"] == "gauss-newton");
  CHECK(near["translation_m"] == 0.01);
  CHECK(near["rotation_rad"] == 0);
  CHECK(near["returned"] == 1);
  CHECK(near["median_translation_m"] < 0.01);
  CHECK(near["median_rotation_rad"] < 0.017);
  CHECK(near["milliseconds"] > 0);
  const nlohmann::json& far = json["starts"][2];
  CHECK(far["translation_m"] == 0.1);
  CHECK(far["median_translation_m"] < 0.05);
  // Three steps of 2 mm do not lead back over 10 cm.
  CHECK(adam_far["method"] == "adam");
  CHECK(adam_far["translation_m"] == 0.1);
  CHECK(adam_far["rotation_rad"].get<double>() == doctest::Approx(0.17453));
  CHECK(adam_far["returned"] == 0);
  CHECK(adam_far["median_translation_m"].get<double>() == doctest::Approx(0.1).epsilon(0.2));

  // Other directions, fewer frames, other settings.
  CHECK(contains(measure({"--frames", "1", "--seed", "2", "--set", "gauss_newton.renders=2"}), "1 frames"));
  const nlohmann::json other = read_json(folder / "basin.json");
  CHECK(other["seed"] == 2);
  CHECK(other["starts"][8]["median_translation_m"] != json["starts"][8]["median_translation_m"]);

  const Outcome unknown =
      surefield_command({"basin", "--run", folder / "out", "--set", "tracking.render=1"}, folder.path());
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "unknown key tracking.render"));
  std::filesystem::remove(folder / "out/map.ply");
  const Outcome mapless = surefield_command({"basin", "--run", folder / "out"}, folder.path());
  CHECK(mapless.code == 2);
  CHECK(contains(mapless.err, "map.ply"));
}

TEST_CASE("basin names what it lacks") {
  const TemporaryFolder folder;
  const auto message = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "basin");
    const Outcome outcome = surefield_command(arguments, folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(message({}), "--run is required"));
  CHECK(contains(message({"--run", "/no/such"}), "/no/such/metrics.json: no such file"));
  CHECK(contains(message({"--run", "/no/such", "--frames", "0"}), "--frames"));
}
