#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "engine/report/plot.h"
#include "engine/report/plot_axes.h"
#include "tests/report/markup.h"

using namespace surefield;
using namespace surefield::test;

namespace {

const double kNone = std::numeric_limits<double>::quiet_NaN();

/// The path data of the first line of a figure.
std::string path_of(const std::string& html) {
  const std::string marker = "class=\"series\"";
  const std::size_t start = html.find(" d=\"", html.find(marker)) + 4;
  return html.substr(start, html.find('"', start) - start);
}

/// The places that path data names.
std::vector<Eigen::Vector2d> places(std::string path) {
  for (char& c : path) c = c == 'M' || c == 'L' ? ' ' : c;
  std::istringstream stream(path);
  std::vector<Eigen::Vector2d> result;
  double x = 0, y = 0;
  while (stream >> x >> y) result.emplace_back(x, y);
  return result;
}

Plot plot_of(std::vector<Eigen::Vector2d> points) {
  return {
      .title = "a <plot>", .x_label = "frame", .y_label = "cm", .series = {{"run", 0, std::move(points)}}};
}

}  // namespace

TEST_CASE("ticks are multiples of 1, 2 or 5, with as many decimals as they need") {
  const Ticks frames = nice_ticks({0, 199}, 8);
  CHECK(frames.values == std::vector<double>{0, 50, 100, 150});
  CHECK(frames.label(50) == "50");
  const Ticks small = nice_ticks({-0.031, 0.052}, 5);
  CHECK(small.values.size() == 4);
  CHECK(small.step == doctest::Approx(0.02));
  CHECK(small.label(small.values[0]) == "-0.02");
  CHECK(small.label(small.values[1]) == "0.00");
  CHECK(nice_ticks({0, 3e6}, 5).label(1e6) == "1000000");
  const AxisRange grown = grown_to_ticks({0, 8.3}, 5);
  CHECK(grown.low == 0);
  CHECK(grown.high == doctest::Approx(10));
  CHECK(grown_to_ticks({0, 10}, 5).high == doctest::Approx(10));
}

TEST_CASE("values land where the axes say") {
  const std::vector<Eigen::Vector2d> at = places(path_of(plot_figure(plot_of({{0, 1}, {5, 4}, {10, 2}}))));
  REQUIRE(at.size() == 3);
  CHECK(at[1].x() == doctest::Approx(0.5 * (at[0].x() + at[2].x())));
  // The y axis starts at zero and ends at 4, so the first is three quarters of the height below the second.
  const double unit = (at[0].y() - at[1].y()) / 3;
  CHECK(unit > 10);
  CHECK(at[2].y() - at[1].y() == doctest::Approx(2 * unit).epsilon(0.01));
  CHECK(at[1].y() == doctest::Approx(10));  // the upper margin
}

TEST_CASE("on a map one metre is as long on both axes") {
  Plot plot = plot_of({{0, 0}, {2, 0}, {2, 0.5}, {-3, 1}});
  plot.equal_scale = true;
  const std::vector<Eigen::Vector2d> at = places(path_of(plot_figure(plot)));
  REQUIRE(at.size() == 4);
  const double unit = (at[1].x() - at[0].x()) / 2;
  CHECK(unit > 20);
  CHECK(at[1].y() - at[2].y() == doctest::Approx(0.5 * unit).epsilon(0.01));
  CHECK(at[0].x() - at[3].x() == doctest::Approx(3 * unit).epsilon(0.01));
}

TEST_CASE("values that do not exist interrupt the line") {
  const std::string path = path_of(plot_figure(plot_of({{0, 1}, {1, 2}, {2, kNone}, {3, 2}, {4, 1}})));
  CHECK(std::count(path.begin(), path.end(), 'M') == 2);
  CHECK(places(path).size() == 4);
  CHECK(plot_figure(plot_of({})) == "");
  CHECK(plot_figure(plot_of({{0, kNone}, {1, 3}})) == "");
}

TEST_CASE("a line of many points becomes one of those that are seen, peaks included") {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 100000; ++i) points.emplace_back(i, i == 31415 ? 9.0 : 1.0);
  const std::string html = plot_figure(plot_of(points));
  CHECK(html.size() < 50000);
  const auto at = places(path_of(html));
  const auto highest =
      std::min_element(at.begin(), at.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  CHECK(highest->y() < 40);
  CHECK(highest->x() ==
        doctest::Approx(at.front().x() + 0.31415 * (at.back().x() - at.front().x())).epsilon(0.01));
}

TEST_CASE("figures are well-formed, named and escaped") {
  Plot plot = plot_of({{0, 1}, {1, 2}});
  plot.series.push_back({"truth & \"more\"", kReferenceColour, {{0, 0}, {1, 1}}});
  plot.marks.push_back({{1, 2}, "frame 1 <lost>"});
  for (bool equal : {false, true}) {
    plot.equal_scale = equal;
    const std::string html = plot_figure(plot);
    CHECK(nesting_problem(html) == "");
    for (const char* part : {"a &lt;plot&gt;", "truth &amp; &quot;more&quot;", "frame 1 &lt;lost&gt;",
                             "class=\"legend\"", ">cm<", ">frame<", "var(--run0)", "var(--reference)"}) {
      CAPTURE(part);
      CHECK(html.find(part) != std::string::npos);
    }
  }
  const std::string constant = plot_figure(plot_of({{0, 0}, {1, 0}}));
  CHECK(constant.find("nan") == std::string::npos);
  CHECK(constant.find("inf") == std::string::npos);
}

TEST_CASE("bars are as long as their totals, their parts in proportion") {
  const std::string html =
      bar_figure({"Time", "s", {"tracking", "mapping"}, {{"long", {6, 2}}, {"short & small", {1, 1}}}});
  CHECK(nesting_problem(html) == "");
  for (const char* part :
       {"width:75.00%", "width:25.00%", "width:12.50%", "8.0 s", "2.0 s", "short &amp; small"}) {
    CAPTURE(part);
    CHECK(html.find(part) != std::string::npos);
  }
  CHECK(nesting_problem(bar_figure({"Time", "s", {"tracking"}, {{"none", {0}}}})) == "");
}
