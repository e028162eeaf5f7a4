#include <fstream>

#include "engine/formats/triangle_mesh.h"
#include "engine/sources/open_dataset.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// Writes the shortest of sequences.
Outcome synth_command(const TemporaryFolder& folder, const std::string& out,
                      const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"synth",  "--frames", "2",     "--size",    "64x48",
                                        "--path", "robot",    "--out", folder / out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return surefield_command(arguments, folder.path());
}

}  // namespace

TEST_CASE("synth writes both layouts with poses and the true mesh, and the readers recognise them") {
  const TemporaryFolder folder;
  for (const std::string layout : {"replica", "tum"}) {
    CAPTURE(layout);
    const Outcome outcome = synth_command(folder, layout, {"--layout", layout, "--sensor", "kinect"});
    REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
    const auto dataset = open_dataset(folder / layout);
    CHECK(dataset.recording->format() == layout);
    CHECK(dataset.recording->count() == 2);
    REQUIRE(dataset.ground_truth);
    CHECK(dataset.recording->load(1).frame.has_value());
    CHECK(read_mesh(folder / (layout + "/mesh.ply")).triangles.size() > 1000);
  }
}

TEST_CASE("synth writes views beside the path as a dataset of its own") {
  const TemporaryFolder folder;
  const Outcome outcome =
      synth_command(folder, "office", {"--layout", "tum", "--sensor", "kinect", "--beside", "3"});
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(open_dataset(folder / "office").recording->count() == 2);
  const auto beside = open_dataset(folder / "office/beside");
  CHECK(beside.recording->count() == 3);
  REQUIRE(beside.ground_truth);
  CHECK(beside.ground_truth->size() == 3);
  CHECK(beside.recording->load(2).frame.has_value());
  // Written again without them, they are gone.
  CHECK(synth_command(folder, "office").code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "office/beside"));
}

TEST_CASE("synth says in its settings from when on a chair stands elsewhere, and the light is another") {
  const TemporaryFolder folder;
  const Outcome outcome = surefield_command(
      {"synth", "--path", "turn", "--seed", "2", "--frames", "300", "--size", "24x18", "--sensor", "kinect",
       "--moved-chair", "--exposure", "double", "--exposure-from", "245", "--out", folder / "turn"},
      folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const nlohmann::json settings = read_json(folder / "turn/synth.json");
  CHECK(settings["chair_moved_at"].get<int>() > 15);
  CHECK(settings["exposure"] == "double");
  CHECK(settings["exposure_from"] == 245);
  // Too short for anything to be seen again.
  const Outcome short_one = synth_command(folder, "short", {"--moved-chair"});
  CHECK(short_one.code == 2);
  CHECK(contains(short_one.err, "no chair"));
  REQUIRE(synth_command(folder, "plain").code == 0);
  CHECK(read_json(folder / "plain/synth.json")["chair_moved_at"].is_null());
}

TEST_CASE("synth names what is wrong with its options, and leaves other people's folders alone") {
  const TemporaryFolder folder;
  for (const auto& [option, value] :
       {std::pair{"--scene", "castle"}, {"--path", "flying"}, {"--frames", "0"}}) {
    const Outcome outcome =
        surefield_command({"synth", option, value, "--out", folder / "wrong"}, folder.path());
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(contains(outcome.err, std::string(option).substr(2)), outcome.err);
  }
  std::filesystem::create_directory(folder / "mine");
  std::ofstream(folder / "mine/thesis.txt") << "all of it";
  const Outcome outcome = synth_command(folder, "mine");
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "mine"));
  CHECK(std::filesystem::exists(folder / "mine/thesis.txt"));
}
