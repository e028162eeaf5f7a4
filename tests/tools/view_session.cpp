#include "tests/tools/view_session.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <random>
#include <sstream>
#include <thread>

#include "engine/io/images.h"
#include "engine/window/viewer.h"

namespace surefield::test {

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

ViewSession::ViewSession(const TemporaryFolder& folder, std::vector<std::string> arguments,
                         const Sizes& sizes)
    : folder_(folder),
      screen_(folder.path(), sizes.screen.width, sizes.screen.height),
      program_(std::move(arguments), folder.path()) {
  window_ = screen_.find_window("Surefield");
  if (!sizes.window.empty())
    screen_.act(fmt::format("windowsize {} {} {}", window_, sizes.window.width, sizes.window.height));
  screen_.act("mousemove 600 300");
  // Until the first picture, the window is of one colour there.
  wait_for([&] {
    cv::Scalar mean, spread;
    cv::meanStdDev(screen_.picture()(cv::Rect(380, 20, 100, 100)), mean, spread);
    return spread[1] > 1;
  });
}

std::string ViewSession::stem() const {
  return fmt::format("screenshot_{:04}", screenshots_);
}

bool ViewSession::changes(const std::string& act) {
  const cv::Mat before = settle();
  screen_.act(act);
  return wait_for([&] { return cv::norm(before, screen_.picture(), cv::NORM_INF) > 8; });
}

cv::Mat ViewSession::save() {
  ++screenshots_;
  screen_.act("key p");
  const bool there = wait_for([&] { return std::filesystem::exists(camera()); });
  REQUIRE_MESSAGE(there, program_.err());
  return read_colour(folder_ / (stem() + ".png"));
}

cv::Mat ViewSession::screenshot() {
  const cv::Mat saved = save();
  double difference = 255;
  wait_for([&] {
    const cv::Mat shown = screen_.picture()(cv::Rect(0, 0, saved.cols, saved.rows));
    difference = cv::norm(shown, saved, cv::NORM_INF);
    return difference <= 1;
  });
  CHECK(difference <= 1);
  return saved;
}

std::string ViewSession::line_after(const std::string& act, const std::string& word) {
  settle();
  const std::size_t before = program_.out().size();
  screen_.act(act);
  std::string found;
  wait_for([&] {
    std::istringstream lines(program_.out().substr(before));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(word) && !lines.eof()) found = line;
    return !found.empty();
  });
  return found;
}

int ViewSession::close() {
  screen_.act("mousemove 60 60 key Escape");  // what has been hidden gets keys again only under the mouse
  const int code = program_.wait();
  CHECK_MESSAGE(!contains(program_.err(), "validation"), program_.err());
  return code;
}

cv::Mat ViewSession::settle() const {
  // A busy machine shows a picture for a while before the next change comes.
  constexpr int kRests = 8;
  cv::Mat last;
  int same = 0;
  wait_for([&] {
    const cv::Mat now = screen_.picture();
    same = !last.empty() && cv::norm(last, now, cv::NORM_INF) == 0 ? same + 1 : 0;
    last = now;
    return same >= kRests;
  });
  return last;
}

}  // namespace surefield::test
