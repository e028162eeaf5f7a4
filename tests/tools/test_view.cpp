#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <random>
#include <thread>

#include "engine/formats/ply.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/window/viewer.h"
#include "tests/tools/support.h"
#include "tests/tools/virtual_screen.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// A heap of Gaussians of all colours around a place 2 m before the first camera.
GaussianCloud heap() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  GaussianCloud cloud;
  cloud.resize(400);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.means[i] = {0.6f * uniform(random), 0.4f * uniform(random), 2 + 0.5f * uniform(random)};
    cloud.log_scales[i].setConstant(std::log(0.03f));
    cloud.opacity_logits[i] = 3 * uniform(random);
    for (int c = 0; c < 3; ++c) cloud.sh[3 * i + c] = 1.7f * uniform(random);
  }
  return cloud;
}

/// Waits for something, at most half a minute.
bool wait_for(const std::function<bool()>& happened) {
  for (int i = 0; i < 300; ++i) {
    if (happened()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

bool can_show_windows() {
  if (VirtualScreen::available() && !viewer_problem().starts_with("this program was built without"))
    return true;
  MESSAGE("skipped: needs Xvfb, xdotool and a build with GLFW and Dear ImGui");
  return false;
}

/// A viewer on a virtual screen, and what is done to it.
class Session {
 public:
  Session(const TemporaryFolder& folder, std::vector<std::string> arguments)
      : folder_(folder), screen_(folder.path(), 900, 600), program_(std::move(arguments), folder.path()) {
    window_ = screen_.find_window("Surefield");
    screen_.act("windowsize " + window_ + " 700 450");
    screen_.act("mousemove 600 300");
  }

  /// Presses a key that changes the picture, and waits until it has changed.
  bool changes(const std::string& act) {
    settle();
    const cv::Mat before = screen_.picture();
    screen_.act(act);
    return wait_for([&] { return cv::norm(before, screen_.picture(), cv::NORM_INF) > 8; });
  }

  /// Saves a screenshot; the window must show the same, which is the picture that is returned.
  cv::Mat screenshot() {
    ++screenshots_;
    const std::string stem = this->stem();
    screen_.act("key p");
    const bool there = wait_for([&] { return std::filesystem::exists(folder_ / (stem + ".json")); });
    REQUIRE_MESSAGE(there, program_.err());
    const cv::Mat saved = read_colour(folder_ / (stem + ".png"));
    double difference = 255;
    wait_for([&] {
      const cv::Mat shown = screen_.picture()(cv::Rect(0, 0, saved.cols, saved.rows));
      difference = cv::norm(shown, saved, cv::NORM_INF);
      return difference <= 1;
    });
    CHECK(difference <= 1);
    return saved;
  }

  /// The camera of the last screenshot, as a file.
  std::filesystem::path camera() const { return folder_ / (stem() + ".json"); }

  /// Closes the window; returns the exit code.
  int close() {
    screen_.act("mousemove 60 60 key Escape");  // what has been hidden gets keys again only under the mouse
    const int code = program_.wait();
    CHECK_MESSAGE(!contains(program_.err(), "validation"), program_.err());
    return code;
  }

  /// Waits until the screen rests.
  void settle() const {
    cv::Mat last;
    wait_for([&] {
      const cv::Mat now = screen_.picture();
      const bool rests = !last.empty() && cv::norm(last, now, cv::NORM_INF) == 0;
      last = now;
      return rests;
    });
  }

  void act(const std::string& words) const { screen_.act(words); }
  const std::string& window() const { return window_; }

 private:
  /// Of the last screenshot's files.
  std::string stem() const { return fmt::format("screenshot_{:04}", screenshots_); }

  const TemporaryFolder& folder_;
  VirtualScreen screen_;
  Program program_;
  std::string window_;
  int screenshots_ = 0;
};

}  // namespace

TEST_CASE(
    "[slow] the window shows what render paints, obeys keys and mouse, and survives being resized and "
    "hidden") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", heap());
  Session session(folder, {"view", folder / "map.ply", "--out", folder.path(), "--validate"});
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
  Session session(folder, arguments);
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
