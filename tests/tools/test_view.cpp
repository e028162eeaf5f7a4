#include <opencv2/core.hpp>

#include "engine/formats/ply.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "tests/tools/view_session.h"

using namespace surefield;
using namespace surefield::test;

TEST_CASE(
    "[slow] the window shows what render paints, obeys keys and mouse, and survives being resized and "
    "hidden") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", heap());
  ViewSession session(folder, {"view", folder / "map.ply", "--out", folder.path(), "--validate"});
  CHECK(session.changes("key Tab"));  // hides the panel
  const cv::Mat first = session.screenshot();
  CHECK(first.size() == cv::Size(700, 450));
  const Outcome rendered =
      surefield_command({"render", "--map", folder / "map.ply", "--camera", session.camera(), "--out",
                         folder / "render", "--mode", "colour"},
                        folder.path());
  REQUIRE_MESSAGE(rendered.code == 0, rendered.err);
  CHECK(cv::norm(first, read_colour(folder / "render/colour.png"), cv::NORM_INF) <= 1);

  CHECK(session.changes("mousedown 1 mousemove 500 330 mouseup 1"));  // orbits
  CHECK(session.changes("mousedown 3 mousemove 520 300 mouseup 3"));  // pans
  CHECK(session.changes("click 4"));                                  // comes closer
  for (const std::string mode : {"2", "3", "4", "6", "7", "8", "9"}) {
    CAPTURE(mode);
    CHECK(session.changes("key " + mode));
    session.screenshot();
  }
  session.act("windowsize " + session.window() + " 333 222");
  session.settle();
  CHECK(session.screenshot().size() == cv::Size(333, 222));
  session.act("windowunmap --sync " + session.window());
  session.act("windowmap --sync " + session.window());
  session.settle();
  session.act("windowsize " + session.window() + " 1 1");
  session.act("windowsize " + session.window() + " 640 400");
  session.act("mousemove 300 200");
  session.settle();
  CHECK(session.screenshot().size() == cv::Size(640, 400));
  session.act("key Home 1");
  session.settle();
  session.act("key m");
  CHECK(wait_for([&] { return std::filesystem::exists(folder / "map_0001.ply"); }));
  CHECK(session.close() == 0);
  CHECK(read_ply(folder / "map_0001.ply").cloud.means == heap().means);
}

TEST_CASE("[slow] a run with a viewer gives the trajectory of one without, whatever the user looks at") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  const Outcome alone = surefield_command(short_run(folder / "alone", 6), folder.path());
  REQUIRE_MESSAGE(alone.code == 0, alone.err);
  std::vector<std::string> arguments = short_run(folder / "seen", 6);
  arguments.insert(arguments.end(), {"--viewer", "--validate"});
  ViewSession session(folder, arguments);
  for (const char* words :
       {"key Tab", "key 7", "key space", "key n", "mousedown 1 mousemove 480 350 mouseup 1", "key 0", "key c",
        "key space", "key b", "key 1", "key Page_Up"})
    session.act(words);
  session.act("windowsize " + session.window() + " 320 200");
  session.act("windowunmap --sync " + session.window());
  session.act("windowmap --sync " + session.window());
  CHECK(wait_for([&] { return std::filesystem::exists(folder / "seen/metrics.json"); }));
  session.settle();
  CHECK(session.close() == 0);
  CHECK(read_file(folder / "seen/trajectory.txt") == read_file(folder / "alone/trajectory.txt"));
  CHECK(read_file(folder / "seen/map.ply") == read_file(folder / "alone/map.ply"));
}

TEST_CASE("without a display, the viewer says so and names the way out") {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", heap());
  const Outcome view = surefield_command({"view", folder / "map.ply"}, folder.path());
  CHECK(view.code == 2);
  CHECK(contains(view.err, "surefield render"));
  std::vector<std::string> arguments = short_run(folder / "out");
  arguments.push_back("--viewer");
  const Outcome run = surefield_command(arguments, folder.path());
  CHECK(run.code == 2);
  CHECK(contains(run.err, "run without it"));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}
