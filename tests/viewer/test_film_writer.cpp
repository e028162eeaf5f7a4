#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "engine/io/images.h"
#include "engine/viewer/film_writer.h"
#include "tests/support/input_files.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// Black with a white bar that goes right, red below: not the same upside down or mirrored.
cv::Mat picture(int number, int width, int height) {
  cv::Mat image(height, width, CV_8UC3, cv::Scalar(0, 0, 0));
  image.rowRange(height - height / 4, height).setTo(cv::Scalar(255, 0, 0));
  image(cv::Rect(8 * number, 0, 8, height / 2)).setTo(cv::Scalar(255, 255, 255));
  return image;
}

bool film_exists(const FilmWriter& film) {
  if (film.notice().empty()) return true;
  MESSAGE("skipped: ", film.notice());
  return false;
}

}  // namespace

TEST_CASE("a film has as many pictures as were added, as they were, at their size and rate") {
  const TemporaryFolder folder;
  for (const char* name : {"new/film.mp4", "film.avi"}) {
    CAPTURE(name);
    FilmWriter writer(folder / name, 12);
    for (int i = 0; i < 5; ++i) writer.add(picture(i, 65, 48));
    writer.close();
    CHECK(writer.pictures() == 5);
    if (!film_exists(writer)) continue;
    CHECK(writer.output() == folder / name);
    cv::VideoCapture film((folder / name).string());
    REQUIRE(film.isOpened());
    CHECK(film.get(cv::CAP_PROP_FPS) == doctest::Approx(12));
    cv::Mat read;
    for (int i = 0; i < 5; ++i) {
      REQUIRE(film.read(read));
      REQUIRE(read.size() == cv::Size(64, 48));  // the odd column is left out
      cv::Mat expected;
      cv::cvtColor(picture(i, 65, 48).colRange(0, 64), expected, cv::COLOR_RGB2BGR);
      CHECK(cv::norm(read, expected, cv::NORM_L1) / (3 * 64 * 48) < 12);
    }
    CHECK_FALSE(film.read(read));
  }
}

TEST_CASE("a film that is not closed is closed when its writer goes") {
  const TemporaryFolder folder;
  {
    FilmWriter writer(folder / "film.avi", 10);
    for (int i = 0; i < 3; ++i) writer.add(picture(i, 64, 48));
    if (!film_exists(writer)) return;
  }
  CHECK(cv::VideoCapture((folder / "film.avi").string()).get(cv::CAP_PROP_FRAME_COUNT) == 3);
}

TEST_CASE("a folder takes a series of PNGs, without what an earlier, longer one left") {
  const TemporaryFolder folder;
  for (int count : {4, 2}) {
    FilmWriter writer(folder / "series", 25);
    for (int i = 0; i < count; ++i) writer.add(picture(i, 65, 47));
    writer.close();
    CHECK(writer.notice().empty());
  }
  CHECK(cv::norm(read_colour(folder / "series/000001.png"), picture(1, 65, 47), cv::NORM_INF) == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "series/000002.png"));
  CHECK_FALSE(std::filesystem::exists(folder / "series/000003.png"));
}

TEST_CASE("where no codec can write the film, a series of PNGs beside it has the pictures") {
  const TemporaryFolder folder;
  FilmWriter writer(folder / "film.mp4", 25);
  const cv::Mat line(1, 40, CV_8UC3, cv::Scalar(1, 2, 3));  // no codec takes a height of 1
  for (int i = 0; i < 2; ++i) writer.add(line);
  writer.close();
  CHECK(writer.output() == folder / "film_frames");
  CHECK(contains(writer.notice(), "no codec"));
  CHECK(contains(writer.notice(), "film_frames"));
  CHECK(cv::norm(read_colour(folder / "film_frames/000001.png"), line, cv::NORM_INF) == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "film.mp4"));
}

TEST_CASE("a film of an unknown kind, or in the place of a folder, is refused at once") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "here.mp4");
  const auto error = [&](const char* name) { return input_error([&] { FilmWriter(folder / name, 25); }); };
  CHECK(contains(error("film.gif"), "film.gif: films end in .mp4 or .avi"));
  CHECK(contains(error("here.mp4"), "is a folder"));
  folder.write("file", "");
  CHECK(contains(error("file/film.mp4"), "cannot be created"));
}

TEST_CASE("a film without a picture leaves no file") {
  const TemporaryFolder folder;
  FilmWriter writer(folder / "film.mp4", 25);
  writer.close();
  CHECK_FALSE(std::filesystem::exists(folder / "film.mp4"));
}
