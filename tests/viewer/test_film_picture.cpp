#include <doctest/doctest.h>

#include "engine/viewer/film_picture.h"

using namespace surefield;

namespace {

const cv::Scalar kGround(40, 40, 40), kGreen(0, 200, 0);

int changed(const cv::Mat& picture, const cv::Rect& part) {
  cv::Mat difference;
  cv::absdiff(picture(part), kGround, difference);
  return cv::countNonZero(difference.reshape(1));
}

}  // namespace

TEST_CASE("an inset lies in its corner, not larger than its share, and leaves the rest as it was") {
  for (Corner corner : {Corner::BottomLeft, Corner::BottomRight}) {
    cv::Mat picture(180, 320, CV_8UC3, kGround);
    add_inset(picture, cv::Mat(480, 640, CV_8UC3, kGreen), corner, "x");
    const bool left = corner == Corner::BottomLeft;
    const cv::Rect share(left ? 0 : 240, 120, 80, 60);
    CHECK(changed(picture, {0, 0, 320, 120}) == 0);
    CHECK(changed(picture, {left ? 80 : 0, 120, 240, 60}) == 0);
    CHECK(changed(picture, share) > 3 * 60 * 40);
    CHECK(picture.at<cv::Vec3b>(165, left ? 40 : 280) == cv::Vec3b(0, 200, 0));
  }
}

TEST_CASE("an inset for which there is no room, and a caption longer than the picture, do no harm") {
  cv::Mat picture(16, 16, CV_8UC3, kGround);
  add_inset(picture, cv::Mat(4, 400, CV_8UC3, kGreen), Corner::BottomRight, "a long name");
  add_caption(picture, "a caption that is far longer than the picture");
  CHECK(picture.size() == cv::Size(16, 16));
}

TEST_CASE("a caption is at the top left") {
  cv::Mat picture(180, 320, CV_8UC3, kGround);
  add_caption(picture, "frame 7");
  CHECK(changed(picture, {0, 0, 120, 30}) > 200);
  CHECK(changed(picture, {0, 30, 320, 150}) == 0);
  CHECK(changed(picture, {120, 0, 200, 180}) == 0);
}
