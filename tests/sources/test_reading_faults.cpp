// Recordings as people have them: other spellings, orders and lists than the benchmarks'.
#include <fmt/format.h>
#include <sys/stat.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/io/files.h"
#include "engine/sources/camera_file.h"
#include "engine/sources/frame_stream.h"
#include "engine/sources/open_dataset.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

const std::string kCamera = "fx: 30\nfy: 31\ncx: 19.5\ncy: 14.5\ndepth_unit: 0.001\n";
constexpr const char* kIdentityRows = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

/// An image of 40 x 30 whose colour, or depth, is `value` (times 10 mm).
void write_colour(const TemporaryFolder& folder, const std::string& name, int value) {
  std::filesystem::create_directories((folder / name).parent_path());
  REQUIRE(cv::imwrite((folder / name).string(), cv::Mat(30, 40, CV_8UC3, cv::Scalar::all(value))));
}

void write_depth(const TemporaryFolder& folder, const std::string& name, int value) {
  std::filesystem::create_directories((folder / name).parent_path());
  REQUIRE(cv::imwrite((folder / name).string(), cv::Mat(30, 40, CV_16UC1, cv::Scalar::all(10 * value))));
}

/// The values of the frames in their order, of colour and of depth, which have to be the same.
std::vector<int> values(const Dataset& dataset) {
  std::vector<int> list;
  for (int i = 0; i < dataset.recording->count(); ++i) {
    const LoadedFrame loaded = dataset.recording->load(i);
    REQUIRE_MESSAGE(loaded.frame, loaded.problem);
    list.push_back(loaded.frame->colour.at<cv::Vec3b>(3, 3)[0]);
    CHECK(loaded.frame->depth.at<float>(3, 3) == doctest::Approx(0.01 * list.back()));
  }
  return list;
}

bool any_contains(const std::vector<std::string>& lines, const std::string& part) {
  return std::any_of(lines.begin(), lines.end(), [&](const auto& line) { return contains(line, part); });
}

std::vector<int> up_to(int count) {
  std::vector<int> list(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) list[static_cast<std::size_t>(i)] = i;
  return list;
}

}  // namespace

TEST_CASE("plain: numbers without leading zeros are in the order of the numbers") {
  const TemporaryFolder folder;
  folder.write("camera.yaml", kCamera);
  for (int i = 0; i < 12; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  CHECK(values(open_dataset(folder.path())) == up_to(12));
}

TEST_CASE("plain: spellings of the same number are a pair") {
  const TemporaryFolder folder;
  folder.write("camera.yaml", kCamera);
  for (int i = 0; i < 12; ++i) {
    write_colour(folder, fmt::format("color/image_{:04}.png", i), i);
    write_depth(folder, fmt::format("depth/depth{}.png", i), i);
  }
  folder.write("color/._image_0000.png", "a desktop's note");
  const Dataset dataset = open_dataset(folder.path());
  CHECK(values(dataset) == up_to(12));
  CHECK(any_contains(dataset.recording->assumptions(), "same number in their names"));
}

TEST_CASE("plain: names that are time stamps give order, pairs and stamps") {
  const TemporaryFolder folder;
  folder.write("camera.yaml", kCamera);
  for (int i = 0; i < 4; ++i) {
    write_colour(folder, fmt::format("colour/{:.6f}.png", 1305031102.175304 + 0.033 * i), i);
    write_depth(folder, fmt::format("depth/{:.6f}.png", 1305031102.180000 + 0.033 * i), i);
  }
  const Dataset dataset = open_dataset(folder.path());
  CHECK(values(dataset) == up_to(4));
  CHECK(dataset.recording->timestamp(1) == doctest::Approx(1305031102.208304).epsilon(1e-12));
  CHECK(dataset.recording->depth_timestamp(1) == doctest::Approx(1305031102.213).epsilon(1e-12));
  CHECK(dataset.recording->depth_after(1) == doctest::Approx(0.004696).epsilon(1e-3));
}

TEST_CASE("plain: a list of times alone, in nanoseconds, gives the stamps") {
  const TemporaryFolder folder;
  folder.write("camera.yaml", kCamera);
  for (int i = 0; i < 3; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  folder.write("timestamps.txt", "1403636579763555584\n1403636579813555456\n1403636579863555584\n");
  const Dataset dataset = open_dataset(folder.path());
  CHECK(dataset.recording->timestamp(1) - dataset.recording->timestamp(0) ==
        doctest::Approx(0.05).epsilon(1e-4));
  folder.write("timestamps.txt", "1\n2\n");
  CHECK(contains(input_error([&] { open_dataset(folder.path()); }), "has 2 time stamps for 3 pairs"));
}

TEST_CASE("TUM: lists as other systems write them") {
  const TemporaryFolder folder("own");
  folder.write("camera.yaml", kCamera);
  for (int i = 0; i < 3; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  const std::string plain = "1.00 rgb/0.png\n1.05 rgb/1.png\n1.10 rgb/2.png\n";
  for (const char* rows :
       {"\xef\xbb\xbf"
        "1.00 rgb/0.png\r\n1.05 rgb/1.png\r\n1.10 rgb/2.png\r\n",
        "timestamp filename\n1.00 rgb/0.png\n1.05 rgb/1.png\n1.10 rgb/2.png",
        "+1.00 rgb\\0.png\n+1.05 rgb\\1.png  \n+1.10 rgb\\2.png\n",
        "#t,file\n1.00,rgb/0.png\n1.05,rgb/1.png\n1.10,rgb/2.png\n",
        "1.00 rgb/0000.png\n1.05 rgb/0001.jpg\n1.10 rgb/0002.PNG\n",
        "1000000000000000000 rgb/0.png\n1000000000050000000 rgb/1.png\n1000000000100000000 rgb/2.png\n"}) {
    CAPTURE(rows);
    folder.write("rgb.txt", rows);
    std::string depth = rows;
    for (auto at = depth.find("rgb"); at != std::string::npos; at = depth.find("rgb", at))
      depth.replace(at, 3, "depth");
    folder.write("depth.txt", depth);
    const Dataset dataset = open_dataset(folder.path());
    CHECK(values(dataset) == up_to(3));
    CHECK(dataset.recording->timestamp(2) - dataset.recording->timestamp(0) ==
          doctest::Approx(0.1).epsilon(1e-5));
    CHECK(dataset.recording->intrinsics().width == 40);
  }
}

TEST_CASE("TUM: stamps that go back or repeat are named, and the frames sorted") {
  const TemporaryFolder folder("own");
  folder.write("camera.yaml", kCamera);
  for (int i = 0; i < 3; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  folder.write("depth.txt", "1.00 depth/0.png\n1.05 depth/1.png\n1.10 depth/2.png\n");
  folder.write("rgb.txt", "1.00 rgb/0.png\n1.10 rgb/2.png\n1.05 rgb/1.png\n");
  Dataset dataset = open_dataset(folder.path());
  CHECK(values(dataset) == up_to(3));
  CHECK(any_contains(dataset.recording->warnings(), "rgb.txt:3: the time goes back"));
  folder.write("rgb.txt", "1.00 rgb/0.png\n1.00 rgb/0.png\n1.05 rgb/1.png\n");
  dataset = open_dataset(folder.path());
  CHECK(any_contains(dataset.recording->warnings(), "1 of 3 frames have the time stamp of the frame before"));
}

TEST_CASE("a list of pairs is not taken for ICL-NUIM where the user brings a camera") {
  const TemporaryFolder folder("kitchen");
  for (int i = 0; i < 3; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  folder.write("associations.txt",
               "0 rgb/0.png 0 depth/0.png\n1 rgb/1.png 1 depth/1.png\n2 rgb/2.png 2 depth/2.png\n");
  folder.write("groundtruth.txt", "0 0 0 0 0 0 0 1\n1 0 0.5 0 0 0 0 1\n2 0 1 0 0 0 0 1\n");
  CHECK(contains(input_error([&] { open_dataset(folder.path()); }), "the camera is unknown"));
  folder.write("camera.yaml", kCamera);
  const Dataset dataset = open_dataset(folder.path());
  CHECK(dataset.recording->format() == "tum");
  CHECK(dataset.recording->intrinsics().fx == 30);
  CHECK(values(dataset) == up_to(3));
  CHECK(dataset.ground_truth->at(1).camera_to_world.translation().y() == 0.5);
  // The user may say that it is.
  CHECK(open_dataset(folder.path(), {.format = "icl"}).recording->format() == "icl");
}

TEST_CASE("a camera of the user goes before that of a layout, and what is assumed is said") {
  const TemporaryFolder folder("rgbd_dataset_freiburg1_own");
  write_colour(folder, "rgb/0.png", 1);
  write_depth(folder, "depth/0.png", 1);
  folder.write("rgb.txt", "1.00 rgb/0.png\n");
  folder.write("depth.txt", "1.00 depth/0.png\n");
  CHECK(any_contains(open_dataset(folder.path()).recording->assumptions(), "TUM's freiburg1"));
  const Dataset assumed = open_dataset(folder.path(), {.camera = "freiburg3", .depth_unit = 0.002});
  CHECK(assumed.recording->intrinsics().fx == 535.4);
  CHECK(assumed.recording->depth_unit() == 0.002);
  CHECK(any_contains(assumed.recording->assumptions(), "freiburg3"));
  folder.write("camera.yaml", kCamera);
  CHECK(open_dataset(folder.path()).recording->intrinsics().fx == 30);
  const auto other =
      folder.write("other.yaml", "width: 40\nheight: 30\n" + kCamera + "distortion: [0.1, 0, 0, 0]\n");
  CHECK(open_dataset(folder.path(), {.camera = other.string()}).recording->load(0).frame);

  const TemporaryFolder scenes("seq-01");
  write_colour(scenes, "frame-000000.color.png", 1);
  write_depth(scenes, "frame-000000.depth.png", 1);
  CHECK(any_contains(open_dataset(scenes.path()).recording->assumptions(), "7-Scenes' Kinect"));
  scenes.write("camera.yaml", kCamera);
  CHECK(values(open_dataset(scenes.path())) == std::vector{1});
}

TEST_CASE("truth that cannot be read, or of another clock, is a warning and stops nothing") {
  const TemporaryFolder folder("own_fr3");
  for (int i = 0; i < 2; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  folder.write("rgb.txt", "100.0 rgb/0.png\n100.1 rgb/1.png\n");
  folder.write("depth.txt", "100.0 depth/0.png\n100.1 depth/1.png\n");
  folder.write("groundtruth.txt", "100.0 one two\n");
  Dataset dataset = open_dataset(folder.path());
  CHECK_FALSE(dataset.ground_truth);
  CHECK(any_contains(dataset.recording->warnings(), "the ground truth is not used: "));
  folder.write("groundtruth.txt",
               "# note\ntimestamp tx ty tz qx qy qz qw\n100.0 1 2 3 0 0 0 1\n100.1 1 2 3 0 0 0 1\n");
  CHECK(open_dataset(folder.path()).ground_truth->size() == 2);
  folder.write("groundtruth.txt", "7.0 1 2 3 0 0 0 1\n7.1 1 2 3 0 0 0 1\n");
  dataset = open_dataset(folder.path());
  CHECK(any_contains(dataset.recording->warnings(), "no pose of the ground truth is near a frame"));
  CHECK(any_contains(dataset.recording->warnings(), "the clocks differ by 93.00 s"));
  // KITTI's format: a pose a row, in the order of the frames.
  folder.write("groundtruth.txt", "1 0 0 4 0 1 0 5 0 0 1 6\n1 0 0 7 0 1 0 5 0 0 1 6\n");
  dataset = open_dataset(folder.path());
  REQUIRE(dataset.ground_truth->size() == 2);
  CHECK(dataset.ground_truth->at(1).timestamp == 100.1);
  CHECK(dataset.ground_truth->at(1).camera_to_world.translation().x() == 7);
}

TEST_CASE("ScanNet and 7-Scenes: numbers of poses and images are read however they are spelt") {
  const TemporaryFolder folder("scene0000_00");
  folder.write("intrinsic/intrinsic_depth.txt", "36 0 19.5 0\n0 37 14.5 0\n0 0 1 0\n0 0 0 1\n");
  for (int i = 0; i < 3; ++i) {
    write_colour(folder, fmt::format("color/{}.JPG", i), 10 * i);
    write_depth(folder, fmt::format("depth/{:06}.png", i), 10 * i);
    folder.write(fmt::format("pose/{:06}.txt", i), kIdentityRows);
  }
  const Dataset dataset = open_dataset(folder.path());
  CHECK(dataset.recording->count() == 3);
  CHECK(dataset.recording->load(2).frame);
  REQUIRE(dataset.ground_truth);
  CHECK(dataset.ground_truth->size() == 3);
  folder.write("pose/000001.txt", "broken");
  CHECK(any_contains(open_dataset(folder.path()).recording->warnings(), "000001.txt: expected a rigid"));

  const TemporaryFolder scenes("seq-01");
  for (int i = 0; i < 3; ++i) {
    write_colour(scenes, fmt::format("frame-{}.color.png", i), i);
    write_depth(scenes, fmt::format("frame-{}.depth.png", i), i);
    scenes.write(fmt::format("frame-{}.pose.txt", i), kIdentityRows);
  }
  CHECK(open_dataset(scenes.path()).ground_truth->size() == 3);
}

TEST_CASE("numbers that are stamps make no frames between them") {
  const TemporaryFolder folder("seq-01");
  for (int number : {7, 1000000, 2000000000}) {
    write_colour(folder, fmt::format("frame-{}.color.png", number), 1);
    write_depth(folder, fmt::format("frame-{}.depth.png", number), 1);
  }
  CHECK(open_dataset(folder.path()).recording->count() == 3);
}

TEST_CASE("one image that cannot be opened at all is one bad frame") {
  const TemporaryFolder folder;
  folder.write("camera.yaml", "width: 40\nheight: 30\n" + kCamera);
  for (int i = 0; i < 4; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  std::filesystem::remove(folder / "rgb/1.png");
  std::filesystem::create_symlink("1.png", folder / "rgb/1.png");
  std::filesystem::remove(folder / "depth/2.png");
  REQUIRE(mkfifo((folder / "depth/2.png").c_str(), 0600) == 0);
  const Dataset dataset = open_dataset(folder.path());
  REQUIRE(dataset.recording->count() == 4);
  CHECK(dataset.recording->load(0).frame);
  CHECK(contains(dataset.recording->load(1).problem, "rgb/1.png: cannot be opened"));
  CHECK(contains(dataset.recording->load(2).problem, "depth/2.png: is no file on a disk"));
  CHECK(dataset.recording->load(3).frame);
}

TEST_CASE("a stream gives up where nothing can be read, if it is told to") {
  const TemporaryFolder folder;
  folder.write("camera.yaml", "width: 20\nheight: 30\n" + kCamera);
  for (int i = 0; i < 8; ++i) {
    write_colour(folder, fmt::format("rgb/{}.png", i), i);
    write_depth(folder, fmt::format("depth/{}.png", i), i);
  }
  const Dataset dataset = open_dataset(folder.path());
  FrameStream stream(*dataset.recording, {.hopeless = 5});
  CHECK(contains(input_error([&] { stream.next(); }), "none of the first 5 frames can be read: "));
  FrameStream patient(*dataset.recording, FrameSelection{});
  CHECK_FALSE(patient.next());
  CHECK(patient.problems().size() == 8);
}

TEST_CASE("distortion: all lengths of OpenCV's model, and the fisheye model") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& lines) {
    return read_camera_file(folder.write("camera.yaml", kCamera + lines));
  };
  for (const char* list :
       {"[0.1, 0, 0, 0]", "[0.1, 0, 0, 0, 0.2]", "[0.1, 0, 0, 0, 0, 0, 0, 0.2]",
        "[0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.2]", "[0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.2]"})
    CHECK(read(fmt::format("distortion: {}\n", list)).distortion.coefficients.front() == 0.1);
  CHECK(read("distortion: [0, 0, 0, 0]\n").distortion.empty());
  CHECK(read("").distortion.empty());
  CHECK(contains(input_error([&] { read("distortion: [0.1, 0, 0]\n"); }),
                 "a list of 0, 4, 5, 8, 12, 14 numbers"));
  CHECK(contains(input_error([&] { read("distortion_model: fisheye\ndistortion: [0, 0, 0, 0, 0]\n"); }),
                 "a fisheye lens has 4"));
  CHECK(contains(input_error([&] { read("distortion_model: fish\n"); }), "radtan, fisheye"));

  // A fisheye image of a bright square: the square is where OpenCV's projection of its corner says,
  // undistorted.
  folder.write("camera.yaml", kCamera + "distortion_model: fisheye\ndistortion: [0.3, 0.1, 0, 0]\n");
  const cv::Matx33d k(30, 0, 19.5, 0, 31, 14.5, 0, 0, 1);
  std::vector<cv::Point2d> pinhole = {{(32 - 19.5) / 30, (24 - 14.5) / 31}}, stored;
  cv::fisheye::distortPoints(pinhole, stored, k, cv::Vec4d(0.3, 0.1, 0, 0));
  cv::Mat colour(30, 40, CV_8UC3, cv::Scalar::all(0));
  cv::circle(colour, cv::Point(cvRound(stored[0].x), cvRound(stored[0].y)), 1, cv::Scalar::all(255), -1);
  std::filesystem::create_directories(folder / "rgb");
  REQUIRE(cv::imwrite((folder / "rgb/0.png").string(), colour));
  write_depth(folder, "depth/0.png", 1);
  const LoadedFrame loaded = open_dataset(folder.path()).recording->load(0);
  REQUIRE_MESSAGE(loaded.frame, loaded.problem);
  CHECK(loaded.frame->colour.at<cv::Vec3b>(24, 32)[0] > 128);
}

TEST_CASE("what is given in the place of a folder is named") {
  const TemporaryFolder folder;
  write_colour(folder, "recording/rgb/0.png", 1);
  write_depth(folder, "recording/depth/0.png", 1);
  CHECK(contains(input_error([&] { open_dataset(folder.path()); }),
                 "; recording in it has that of plain: give it"));
  CHECK(contains(input_error([&] { open_dataset(folder.write("a.txt", "")); }),
                 "a.txt: is a file; give the folder"));
  CHECK(contains(input_error([&] { open_dataset(folder.write("a.zip", "")); }), "is packed; unpack it"));
  CHECK(
      contains(input_error([&] { open_dataset(folder.write("a.klg", "")); }), "a kind that is not read yet"));
  CHECK(contains(input_error([&] { open_dataset(folder.write("a.bag", "")); }), "is no ROS 1 bag"));
}
