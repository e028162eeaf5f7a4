// What a person asks the viewer, by keys and clicks.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <signal.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <regex>

#include "engine/formats/ply.h"
#include "engine/io/camera_json.h"
#include "tests/tools/view_session.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// The numbers after `name` and "=" in a line: "point=1,2,3".
std::vector<double> numbers_of(const std::string& line, const std::string& name) {
  std::smatch match;
  REQUIRE_MESSAGE(std::regex_search(line, match, std::regex(" " + name + "=([-0-9.,]+)")), line);
  std::vector<double> numbers;
  std::string text = match[1];
  for (std::size_t at = 0; at < text.size(); at = text.find(',', at) + 1) {
    numbers.push_back(std::stod(text.substr(at)));
    if (text.find(',', at) == std::string::npos) break;
  }
  return numbers;
}

Eigen::Vector3d vector_of(const std::string& line, const std::string& name) {
  const std::vector<double> numbers = numbers_of(line, name);
  REQUIRE(numbers.size() == 3);
  return {numbers[0], numbers[1], numbers[2]};
}

/// The smallest rectangle around what differs between two pictures.
cv::Rect what_differs(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference, any;
  cv::absdiff(a, b, difference);
  cv::transform(difference, any, cv::Matx13f(1, 1, 1));
  std::vector<cv::Point> places;
  cv::findNonZero(any > 6, places);
  if (places.empty()) return {};
  cv::Rect around(places[0], cv::Size(1, 1));
  for (const cv::Point& place : places) around |= cv::Rect(place, cv::Size(1, 1));
  return around;
}

/// A wall of large opaque Gaussians 2 m before the first camera: something to click on everywhere.
GaussianCloud wall() {
  GaussianCloud cloud;
  cloud.resize(11 * 11);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto x = static_cast<float>(i % 11) - 5, y = static_cast<float>(i / 11) - 5;
    cloud.means[i] = {0.2f * x, 0.2f * y, 2};
    cloud.log_scales[i] = {std::log(0.1f), std::log(0.1f), std::log(0.002f)};
    cloud.opacity_logits[i] = 5;
    cloud.uncertainty[i] = 0.0001f;
    for (int c = 0; c < 3; ++c) cloud.sh[3 * i + c] = 0.2f * x * static_cast<float>(c - 1) + 0.1f * y;
  }
  return cloud;
}

/// The rows of the panel's headers, by their colour, in a column that no text of theirs reaches.
std::vector<int> header_rows(const cv::Mat& screen, int column) {
  std::vector<int> rows;
  int begin = -1;
  for (int y = 0; y < screen.rows; ++y) {
    const cv::Vec3b c = screen.at<cv::Vec3b>(y, column);
    const bool header = c[2] > c[0] + 25 && c[2] > c[1] + 8 && c[2] < 140;
    if (header && begin < 0) begin = y;
    if (!header && begin >= 0) {
      if (y - begin > 12) rows.push_back((begin + y) / 2);
      begin = -1;
    }
  }
  return rows;
}

}  // namespace

TEST_CASE("[slow] a click tells the surface under it, two of the ruler their distance") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", wall());
  ViewSession session(folder, {"view", folder / "map.ply", "--out", folder.path(), "--validate"});
  CHECK(session.changes("key Tab"));
  const cv::Mat clean = session.screenshot();
  const Camera camera = read_camera(session.camera());
  const auto place_of = [&](const Eigen::Vector3d& point) -> Eigen::Vector2d {
    const Eigen::Vector3d p = camera.world_to_camera * point;
    const Intrinsics& k = camera.intrinsics;
    return {k.fx * p.x() / p.z() + k.cx, k.fy * p.y() / p.z() + k.cy};
  };

  const std::string line = session.line_after("mousemove 320 240 click 1", "picked ");
  CHECK(numbers_of(line, "pixel") == std::vector<double>{320, 240});
  const Eigen::Vector3d point = vector_of(line, "point");
  CHECK((place_of(point) - Eigen::Vector2d(320, 240)).norm() < 0.2);  // four decimals of a metre
  CHECK(point.z() == doctest::Approx(2).epsilon(0.01));
  CHECK((camera.world_to_camera * point).z() == doctest::Approx(numbers_of(line, "depth")[0]).epsilon(0.001));
  CHECK(numbers_of(line, "sigma")[0] == doctest::Approx(0.01));
  CHECK((vector_of(line, "normal") - Eigen::Vector3d(0, 0, -1)).norm() < 0.01);
  const auto gaussian = static_cast<std::size_t>(numbers_of(line, "gaussian")[0]);
  CHECK((wall().means.at(gaussian).cast<double>() - point).norm() < 0.2);

  // The mark is where the click was, and goes when it is forgotten.
  const cv::Rect mark = what_differs(clean, session.screenshot());
  CHECK(mark.contains(cv::Point(320, 240)));
  CHECK(mark.area() < 60 * 60);
  CHECK(session.changes("key Delete"));
  CHECK(what_differs(clean, session.screenshot()).empty());
  CHECK(session.line_after("mousemove 5 445 click 1", "picked ") == "picked nothing");

  session.act("key r");
  CHECK(session.changes("mousemove 260 200 click 1"));
  const std::string measured = session.line_after("mousemove 420 260 click 1", "measured ");
  const Eigen::Vector3d from = vector_of(measured, "from"), to = vector_of(measured, "to");
  CHECK(numbers_of(measured, "distance")[0] == doctest::Approx((to - from).norm()).epsilon(0.001));
  CHECK((place_of(from) - Eigen::Vector2d(260, 200)).norm() < 0.2);
  CHECK((place_of(to) - Eigen::Vector2d(420, 260)).norm() < 0.2);
  const cv::Rect ruler = what_differs(clean, session.screenshot());
  CHECK(ruler.contains(cv::Point(260, 200)));
  CHECK(ruler.contains(cv::Point(420, 260)));
  CHECK(session.changes("key r"));
  CHECK(what_differs(clean, session.screenshot()).empty());

  // A drag is no click.
  const std::size_t said = session.program().out().size();
  CHECK(session.changes("mousemove 400 300 mousedown 1 mousemove 440 320 mouseup 1"));
  CHECK(session.program().out().size() == said);
  CHECK(session.close() == 0);
}

TEST_CASE("[slow] what is under the mouse is told where it rests") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", wall());
  ViewSession session(folder, {"view", folder / "map.ply", "--out", folder.path()});
  session.act("key y mousemove 430 130");
  const cv::Mat before = session.settle();
  CHECK(session.changes("key i"));  // ticks the box of the panel
  CHECK(wait_for([&] { return what_differs(before, session.screen().picture()).br().x > 450; }));
  const cv::Rect hint =
      what_differs(before(cv::Rect(380, 0, 320, 450)), session.settle()(cv::Rect(380, 0, 320, 450)));
  CHECK(hint.x > 430 - 380);
  CHECK(hint.width > 60);
  CHECK(session.changes("mousemove 500 200"));
  CHECK(session.changes("key i"));
  CHECK(wait_for([&] { return what_differs(before, session.screen().picture()).empty(); }));
  CHECK(session.close() == 0);
}

TEST_CASE("[slow] colour bar, axes and scale bar, the background and the resolution are chosen by keys") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", heap());
  ViewSession session(folder, {"view", folder / "map.ply", "--out", folder.path()});
  session.act("click 5 click 5 click 5 click 5 click 5");  // away, so that the corners are free
  const cv::Mat with = session.settle();
  CHECK(session.changes("key y"));
  // Colours have no bar: axes and scale bar alone, in the lower right.
  const cv::Rect axes = what_differs(with, session.settle());
  CHECK(axes.y > 225);
  CHECK(axes.br().x > 660);
  CHECK(session.changes("key y 2"));
  const cv::Mat depth = session.settle();
  CHECK(session.changes("key y"));
  const cv::Rect bar = what_differs(depth, session.settle());
  CHECK(bar.y < 40);
  CHECK(bar.br().x > 660);

  CHECK(session.changes("key y 1 Tab"));
  cv::Vec3b corners[4];
  for (cv::Vec3b& corner : corners) {
    corner = session.screenshot().at<cv::Vec3b>(449, 699);
    CHECK(session.changes("key u"));
  }
  CHECK(cv::norm(corners[0] - cv::Vec3b(41, 41, 43)) < 40);    // one of the squares
  CHECK(cv::norm(corners[1] - cv::Vec3b(41, 41, 43)) < 3);     // dark
  CHECK(cv::norm(corners[2] - cv::Vec3b(235, 235, 237)) < 3);  // light
  CHECK(corners[3] == cv::Vec3b(0, 0, 0));
  for (const cv::Size& size :
       {cv::Size(350, 225), cv::Size(233, 150), cv::Size(175, 112), cv::Size(700, 450)}) {
    CHECK(session.changes("key z"));
    CHECK(session.save().size() == size);
  }
  CHECK(session.close() == 0);
}

TEST_CASE("[slow] a recorded run is played, moved through in seconds, and seen from a keyframe of the list") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  std::vector<std::string> arguments = short_run(folder / "run", 8);
  arguments.insert(arguments.end(), {"--stride", "8"});
  const Outcome run = surefield_command(arguments, folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const ViewSession::Sizes sizes{.screen = {1300, 820}, .window = {}};
  ViewSession session(folder, {"view", folder / "run", "--out", folder.path()}, sizes);
  const cv::Mat begin = session.settle();
  CHECK(session.changes("key Right"));  // the camera, and the time in the panel
  CHECK(session.changes("key Left"));
  CHECK(what_differs(begin, session.settle()).empty());
  CHECK(session.changes("key space"));  // plays: the camera goes on by itself
  const cv::Mat playing = session.screen().picture();
  CHECK(wait_for([&] { return !what_differs(playing, session.screen().picture()).empty(); }));
  session.act("key space");
  session.act("key Home");
  CHECK(session.changes("key n"));
  CHECK(session.changes("key Page_Down"));

  // The third header from below is that of the list of keyframes; its first line leads to the first one.
  const cv::Mat closed = session.settle();
  const std::vector<int> headers = header_rows(closed, 320);
  REQUIRE(headers.size() >= 4);
  const int header = headers[headers.size() - 3], spacing = header - headers[headers.size() - 4];
  session.act(fmt::format("mousemove 100 {}", header));
  CHECK(session.changes("click 1"));
  const int line = header + spacing + 4;
  session.act(fmt::format("mousemove 60 {}", line));
  CHECK(session.changes("click 1"));
  session.act("mousemove 700 400");
  const cv::Mat listed = session.settle();
  CHECK(what_differs(closed(cv::Rect(400, 0, 880, 800)), listed(cv::Rect(400, 0, 880, 800))).area() > 1000);
  // As from the first keyframe, which is the first frame.
  session.act("key Tab t g k l v");
  session.settle();
  session.save();
  const Camera camera = read_camera(session.camera());
  CHECK((camera.world_to_camera.matrix() - Eigen::Matrix4d::Identity()).norm() < 0.02);
  CHECK(session.close() == 0);
}

TEST_CASE("[slow] the panel fits a window of 800 pixels, and is twice as large where that is asked for") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "run", 3), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  cv::Rect panels[2];
  for (int scale : {1, 2}) {
    CAPTURE(scale);
    const ViewSession::Sizes sizes{.screen = {1300 * scale, 820 * scale}, .window = {}};
    ViewSession session(folder, {"view", folder / "run", "--ui-scale", std::to_string(scale)}, sizes);
    CHECK(session.changes("key 6"));  // with a slider for the scale
    CHECK(session.changes("key y"));
    const cv::Mat with = session.settle();
    CHECK(session.changes("key Tab"));
    panels[scale - 1] = what_differs(with, session.settle());
    CHECK(session.close() == 0);
  }
  CHECK(panels[0].x == 8);
  CHECK(panels[0].width == 350);
  // One that has to be scrolled reaches to the margin.
  CHECK(panels[0].br().y < 790);
  CHECK(panels[0].height > 400);
  CHECK(panels[1].x == 16);
  CHECK(panels[1].width == 700);
  CHECK(panels[1].height == doctest::Approx(2 * panels[0].height).epsilon(0.05));
}

TEST_CASE("[slow] until there is a map, the window shows the first frame and says what is done with it") {
  if (!can_show_windows()) return;
  const TemporaryFolder folder;
  std::vector<std::string> arguments = short_run(folder / "run", 3);
  arguments.insert(arguments.end(), {"--set", "first_iterations=3000", "--viewer", "--validate"});
  ViewSession session(folder, arguments);
  session.act("key Tab");
  // The camera's image, with the seconds counted in the middle.
  // The panel is dark, the image is not.
  const cv::Rect part(30, 80, 200, 60);
  CHECK(wait_for([&] { return cv::mean(session.screen().picture()(part))[1] > 80; }));
  const cv::Mat first = session.settle();
  cv::Rect changed;
  CHECK(wait_for([&] { return !(changed = what_differs(first, session.screen().picture())).empty(); }));
  CHECK(changed.y > 200);
  CHECK(changed.br().y < 250);
  CHECK(changed.width < 500);
  CHECK(session.line_after("mousemove 300 200 click 1", "picked ") == "picked nothing");
  session.program().signal(SIGINT);  // ends the run and closes the window
  session.close();
}
