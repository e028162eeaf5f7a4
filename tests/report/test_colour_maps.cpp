#include <doctest/doctest.h>

#include "engine/report/colour_maps.h"
#include "tests/report/markup.h"

using namespace surefield;
using namespace surefield::test;

TEST_CASE("colours span the scale, clamp beyond it, and grey marks what is not valid") {
  const cv::Mat values = (cv::Mat_<float>(1, 5) << 2.0f, 4.0f, -1.0f, 9.0f, 3.0f);
  const cv::Mat valid = (cv::Mat_<uchar>(1, 5) << 1, 1, 1, 1, 0);
  const cv::Mat colours = apply_colours(values, valid, {ColourMap::Depth, 2, 4, "m"});
  const auto near = [](const cv::Vec3b& a, const cv::Vec3b& b) { return cv::norm(a, b, cv::NORM_INF) <= 4; };
  const cv::Vec3b purple(68, 1, 84), yellow(253, 231, 37);  // ends of viridis, RGB
  CHECK(near(colours.at<cv::Vec3b>(0, 0), purple));
  CHECK(near(colours.at<cv::Vec3b>(0, 1), yellow));
  CHECK(near(colours.at<cv::Vec3b>(0, 2), purple));
  CHECK(near(colours.at<cv::Vec3b>(0, 3), yellow));
  CHECK(colours.at<cv::Vec3b>(0, 4) == cv::Vec3b(128, 128, 128));
  const cv::Mat errors = apply_colours(values, valid, {ColourMap::Error, 2, 4, "cm"});
  CHECK(near(errors.at<cv::Vec3b>(0, 0), {0, 0, 4}));
  CHECK(near(errors.at<cv::Vec3b>(0, 1), {252, 255, 164}));  // the end of inferno
}

TEST_CASE("a legend names the ends of the scale and its unit") {
  const std::string html = colour_legend({ColourMap::Depth, 0.5, 4.25, "m"}, "depth");
  CHECK(nesting_problem(html) == "");
  CHECK(html.find("depth 0.5 <img") != std::string::npos);
  CHECK(html.find("> 4.25 m</span>") != std::string::npos);
}
