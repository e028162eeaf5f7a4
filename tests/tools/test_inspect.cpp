#include "tests/tools/support.h"

using namespace surefield::test;

TEST_CASE("[slow] inspect describes a clip, finds nothing wrong with it, and writes the same as JSON") {
  const auto clip = real_clip("replica_room0");
  if (clip.empty()) return;
  const TemporaryFolder folder;
  const Outcome outcome =
      surefield_command({"inspect", clip.string(), "--json", folder / "inspection.json"}, folder.path());
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.out, "replica_room0, format replica"));
  CHECK(contains(outcome.out, "20, 1200 x 680"));
  CHECK(contains(outcome.out, "nothing wrong found"));
  const nlohmann::json json = read_json(folder / "inspection.json");
  CHECK(json["schema"] == "surefield-inspection");
  CHECK(json["frames"] == 20);
  CHECK(json["stamps"]["are_indices"] == true);
  CHECK(json["posed_frames"] == 20);
  CHECK(json["depth"]["holes"].get<double>() < 0.01);
  CHECK(json["check"]["depth_scale"]["judged"] == true);
  CHECK(json["check"]["depth_scale"]["wrong"] == false);
  CHECK(json["findings"].empty());
}

TEST_CASE("inspect names what it cannot open") {
  const TemporaryFolder folder;
  const Outcome outcome = surefield_command({"inspect", folder.path().string()}, folder.path());
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "no known dataset layout"));
}
