// Constructed folders of the layouts ScanNet, ICL-NUIM and plain, and folders that could be of two layouts.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "engine/sources/open_dataset.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

constexpr const char* kIdentityRows = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

void write_image(const TemporaryFolder& folder, const std::string& name, const cv::Mat& image) {
  std::filesystem::create_directories((folder / name).parent_path());
  REQUIRE(cv::imwrite((folder / name).string(), image));
}

void write_depth(const TemporaryFolder& folder, const std::string& name, int steps,
                 cv::Size size = {40, 30}) {
  write_image(folder, name, cv::Mat(size, CV_16UC1, cv::Scalar(steps)));
}

void write_colour(const TemporaryFolder& folder, const std::string& name, cv::Size size = {40, 30}) {
  write_image(folder, name, cv::Mat(size, CV_8UC3, cv::Scalar(10, 100, 200)));
}

std::string open_error(const TemporaryFolder& folder, const std::string& format = "auto") {
  return input_error([&] { open_dataset(folder.path(), {.format = format}); });
}

/// Frames 2, 9 and 10: in the order of the numbers, which is not that of the names.
void write_scannet(const TemporaryFolder& folder) {
  for (int n : {2, 9, 10}) {
    cv::Mat colour(60, 80, CV_8UC3, cv::Scalar(0, 0, 0));
    colour.colRange(0, 40).setTo(cv::Scalar(200, 200, 200));
    write_image(folder, fmt::format("color/{}.jpg", n), colour);
    write_depth(folder, fmt::format("depth/{}.png", n), 1000 + n);
    folder.write(fmt::format("pose/{}.txt", n), kIdentityRows);
  }
  folder.write("intrinsic/intrinsic_depth.txt", "36 0 19.5 0\n0 37 14.5 0\n0 0 1 0\n0 0 0 1\n");
  folder.write("intrinsic/intrinsic_color.txt", "72 0 39.5 0\n0 74 29.5 0\n0 0 1 0\n0 0 0 1\n");
}

const std::string kCamera = "fx: 30\nfy: 31\ncx: 19.5\ncy: 14.5\ndepth_unit: 0.002\n";

void write_plain(const TemporaryFolder& folder) {
  for (const char* name : {"b", "a"}) {
    write_colour(folder, fmt::format("colour/{}.jpg", name));
    write_depth(folder, fmt::format("depth/{}.png", name), name[0] == 'a' ? 500 : 600);
  }
  folder.write("camera.yaml", kCamera);
}

}  // namespace

TEST_CASE("ScanNet: numeric order, colour averaged down to the depth, unknown poses stay as frames") {
  const TemporaryFolder folder("scene0000_00");
  write_scannet(folder);
  folder.write("pose/9.txt",
               "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf");
  const auto dataset = open_dataset(folder.path());
  CHECK(dataset.recording->format() == "scannet");
  CHECK(dataset.recording->name() == "scene0000_00");
  REQUIRE(dataset.recording->count() == 3);
  CHECK(dataset.recording->timestamp(1) == 9);
  CHECK(dataset.recording->timestamp(2) == 10);
  CHECK(dataset.recording->intrinsics().width == 40);
  CHECK(dataset.recording->intrinsics().fx == 36);
  CHECK(dataset.recording->intrinsics().fy == 37);
  CHECK(dataset.recording->intrinsics().cx == 19.5);
  CHECK(dataset.recording->intrinsics().cy == 14.5);
  REQUIRE(dataset.ground_truth);
  CHECK(dataset.ground_truth->size() == 3);
  CHECK_FALSE(dataset.ground_truth->at(1).is_finite());
  CHECK(dataset.ground_truth->at(2).is_finite());
  const LoadedFrame loaded = dataset.recording->load(1);
  REQUIRE_MESSAGE(loaded.frame, loaded.problem);
  CHECK(loaded.frame->colour.size() == cv::Size(40, 30));
  CHECK(loaded.frame->colour.at<cv::Vec3b>(15, 10)[0] > 190);
  CHECK(loaded.frame->colour.at<cv::Vec3b>(15, 30)[0] < 10);
  CHECK(loaded.frame->depth.at<float>(3, 4) == doctest::Approx(1.009));
}

TEST_CASE("ScanNet: what is missing or broken is named") {
  const TemporaryFolder folder;
  write_scannet(folder);
  std::filesystem::remove(folder / "color/9.jpg");
  std::filesystem::remove(folder / "depth/10.png");
  const auto dataset = open_dataset(folder.path());
  REQUIRE(dataset.recording->count() == 3);
  CHECK(contains(dataset.recording->load(1).problem, "9.jpg: no such file"));
  CHECK(contains(dataset.recording->load(2).problem, "10.png: no such file"));
  folder.write("intrinsic/intrinsic_depth.txt", "1 2 3");
  CHECK(contains(open_error(folder), "intrinsic_depth.txt: expected a 4 x 4"));
  std::filesystem::remove(folder / "intrinsic/intrinsic_depth.txt");
  CHECK(contains(open_error(folder), "intrinsic_depth.txt: no such file"));
}

TEST_CASE("ICL-NUIM: a point lands where the renderer with fy = -480 puts it") {
  const TemporaryFolder folder("living_room_traj0_frei_png");
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 0.5, -0.3).normalized();
  const Eigen::Quaterniond turns[2] = {Eigen::Quaterniond(Eigen::AngleAxisd(0.2, axis)),
                                       Eigen::Quaterniond(Eigen::AngleAxisd(-0.15, axis))};
  const Eigen::Vector3d centres[2] = {{0.1, 0.4, -2.25}, {0.3, 0.2, -2.0}};
  std::string truth;
  for (int i = 0; i < 2; ++i) {
    const auto& q = turns[i];
    truth += fmt::format("{} {} {} {} {} {} {} {}\n", i + 1, centres[i].x(), centres[i].y(), centres[i].z(),
                         q.x(), q.y(), q.z(), q.w());
    write_colour(folder, fmt::format("rgb/{}.png", i + 1), {640, 480});
    write_depth(folder, fmt::format("depth/{}.png", i + 1), 10000, {640, 480});
  }
  folder.write("associations.txt", "2 depth/2.png 2 rgb/2.png\n1 depth/1.png 1 rgb/1.png\n");
  folder.write("livingRoom0.gt.freiburg", truth);
  const auto dataset = open_dataset(folder.path());
  CHECK(dataset.recording->format() == "icl");
  REQUIRE(dataset.recording->count() == 2);
  const Intrinsics k = dataset.recording->intrinsics();
  CHECK(k.fy == 480);
  const LoadedFrame loaded = dataset.recording->load(0);
  REQUIRE_MESSAGE(loaded.frame, loaded.problem);
  REQUIRE(dataset.ground_truth->size() == 2);
  const auto& poses = *dataset.ground_truth;
  for (const cv::Point pixel : {cv::Point(100, 60), cv::Point(500, 400), cv::Point(320, 100)}) {
    const double z = loaded.frame->depth.at<float>(pixel);
    CHECK(z == doctest::Approx(2));
    // As the renderer has it: y up, v = -480 y / z + 239.5, poses as in the file.
    const Eigen::Vector3d rendered((pixel.x - 319.5) / 481.2 * z, (pixel.y - 239.5) / -480.0 * z, z);
    const Eigen::Vector3d world = turns[0] * rendered + centres[0];
    const Eigen::Vector3d there = turns[1].conjugate() * (world - centres[1]);
    const double u = 481.2 * there.x() / there.z() + 319.5, v = -480.0 * there.y() / there.z() + 239.5;
    // As Surefield has it.
    const Eigen::Vector3d own((pixel.x - k.cx) / k.fx * z, (pixel.y - k.cy) / k.fy * z, z);
    const Eigen::Vector3d moved = poses[1].camera_to_world.inverse() * (poses[0].camera_to_world * own);
    CHECK(k.fx * moved.x() / moved.z() + k.cx == doctest::Approx(u).epsilon(1e-6));
    CHECK(k.fy * moved.y() / moved.z() + k.cy == doctest::Approx(v).epsilon(1e-6));
    CHECK(moved.z() == doctest::Approx(there.z()).epsilon(1e-6));
  }
  CHECK(poses[0].camera_to_world.linear().determinant() == doctest::Approx(1));
}

TEST_CASE("ICL-NUIM: broken lists are named with the line") {
  const TemporaryFolder folder;
  folder.write("associations.txt", "1 depth/1.png 1 depth/1.png\n");
  folder.write("a.gt.freiburg", "");
  CHECK(contains(open_error(folder), "associations.txt:1: expected"));
  folder.write("associations.txt", "# nothing\n");
  CHECK(contains(open_error(folder), "associations.txt: lists no image"));
  folder.write("associations.txt", "1 rgb/1.png 1 depth/1.png\n");
  folder.write("b.gt.freiburg", "");
  CHECK(contains(open_dataset(folder.path()).recording->warnings().front(), "several *.freiburg"));
}

TEST_CASE("plain: images are paired by their names, in the order of the names") {
  const TemporaryFolder folder("kitchen");
  write_plain(folder);
  write_colour(folder, "colour/c.png");
  folder.write("poses.txt", "0 0 0 0 0 0 0 1\n1 0.5 0 0 0 0 0 1\n");
  const auto dataset = open_dataset(folder.path());
  CHECK(dataset.recording->format() == "plain");
  CHECK(dataset.recording->name() == "kitchen");
  REQUIRE(dataset.recording->count() == 2);
  CHECK(dataset.recording->timestamp(1) == 1);
  CHECK(dataset.recording->depth_unit() == 0.002);
  CHECK(dataset.recording->intrinsics().width == 40);
  CHECK(dataset.recording->intrinsics().height == 30);
  CHECK(dataset.recording->intrinsics().fy == 31);
  CHECK(dataset.recording->load(0).frame->depth.at<float>(0, 0) == doctest::Approx(1.0));
  CHECK(dataset.recording->load(1).frame->depth.at<float>(0, 0) == doctest::Approx(1.2));
  CHECK(dataset.ground_truth->at(1).camera_to_world.translation().x() == 0.5);
  REQUIRE(dataset.recording->warnings().size() == 1);
  CHECK(contains(dataset.recording->warnings().front(), "1 colour or depth images have no partner"));
}

TEST_CASE("plain: timestamps.txt gives stamps and pairs, color/ is accepted") {
  const TemporaryFolder folder;
  write_plain(folder);
  std::filesystem::rename(folder / "colour", folder / "color");
  folder.write("timestamps.txt", "# seconds colour depth\n10.5 b.jpg a.png\n10.6 a.jpg b.png\n");
  const auto dataset = open_dataset(folder.path());
  REQUIRE(dataset.recording->count() == 2);
  CHECK(dataset.recording->timestamp(0) == 10.5);
  CHECK(dataset.recording->load(0).frame->depth.at<float>(0, 0) == doctest::Approx(1.0));
  CHECK(!dataset.ground_truth);
  folder.write("timestamps.txt", "10.5 b.jpg a.png\n10.4 a.jpg b.png\n");
  CHECK(open_dataset(folder.path()).recording->timestamp(0) == 10.4);
  CHECK(contains(open_dataset(folder.path()).recording->warnings().front(),
                 "timestamps.txt:2: the time goes back"));
  folder.write("timestamps.txt", "10.5 b.jpg\n");
  CHECK(contains(open_error(folder), "timestamps.txt:1: expected"));
}

TEST_CASE("plain: what is missing or wrong is named") {
  const TemporaryFolder folder;
  write_plain(folder);
  folder.write("camera.yaml", "width: 20\nheight: 30\n" + kCamera);
  CHECK(contains(open_dataset(folder.path()).recording->load(0).problem,
                 "is 40 x 30 pixels, the calibration is for 20 x 30"));
  std::filesystem::remove(folder / "camera.yaml");
  CHECK(contains(open_error(folder), "camera.yaml is missing"));
  folder.write("camera.yaml", kCamera);
  std::filesystem::remove_all(folder / "depth");
  write_depth(folder, "depth/other.png", 5);
  CHECK(contains(open_error(folder), "none of the 2 colour images"));
}

TEST_CASE("plain: a folder of Open3D's recorders brings its camera along") {
  for (const char* name : {"camera_intrinsic.json", "intrinsic.json"}) {
    const TemporaryFolder folder;
    write_colour(folder, "color/000000.jpg");
    write_depth(folder, "depth/000000.png", 500);
    folder.write(name,
                 R"({"width": 40, "height": 30, "intrinsic_matrix": [31, 0, 0, 0, 32, 0, 19.5, 14.5, 1]})");
    const Dataset dataset = open_dataset(folder.path());
    CHECK(dataset.recording->format() == "plain");
    const Intrinsics k = dataset.recording->intrinsics();
    CHECK(k.width == 40);
    CHECK(k.fx == 31);
    CHECK(k.fy == 32);
    CHECK(k.cx == 19.5);
    CHECK(k.cy == 14.5);
    CHECK(dataset.recording->load(0).frame->depth.at<float>(3, 3) == 0.5f);
    REQUIRE(dataset.recording->assumptions().size() == 1);
    CHECK(contains(dataset.recording->assumptions()[0], name));
    folder.write(name, R"({"width": 40, "height": 30, "depth_scale": 250,
                           "intrinsic_matrix": [31, 0, 0, 0, 32, 0, 19.5, 14.5, 1]})");
    CHECK(open_dataset(folder.path()).recording->load(0).frame->depth.at<float>(3, 3) == 2);
    folder.write("camera.yaml", kCamera);  // one's own goes before it
    CHECK(open_dataset(folder.path()).recording->intrinsics().fx == 30);
  }
}

TEST_CASE("plain: what is wrong with Open3D's camera is named") {
  const TemporaryFolder folder;
  write_colour(folder, "color/000000.jpg");
  write_depth(folder, "depth/000000.png", 500);
  const auto error = [&](const char* json) {
    folder.write("camera_intrinsic.json", json);
    return open_error(folder);
  };
  CHECK(contains(error("{}"), "intrinsic_matrix"));
  CHECK(contains(error(R"({"intrinsic_matrix": [1, 2]})"), "nine numbers"));
  CHECK(
      contains(error(R"({"intrinsic_matrix": [31, 0, 19.5, 0, 32, 14.5, 0, 0, 1]})"), "column after column"));
  CHECK(
      contains(error(R"({"width": 40, "intrinsic_matrix": [31, 0, 0, 0, 32, 0, 19.5, 14.5, 1]})"), "height"));
}

TEST_CASE("TUM's lists with ETH3D's calibration.txt, and with the camera of Bonn's recordings") {
  const TemporaryFolder folder;
  const auto write_lists = [&](const std::string& name) {
    write_colour(folder, name + "/rgb/1.png");
    write_depth(folder, name + "/depth/1.png", 5000);
    folder.write(name + "/rgb.txt", "1.0 rgb/1.png\n");
    folder.write(name + "/depth.txt", "1.0 depth/1.png\n");
  };
  write_lists("table_3");
  CHECK(contains(input_error([&] { open_dataset(folder / "table_3"); }), "calibration.txt"));
  folder.write("table_3/calibration.txt", "726.2 726.3 20.5 15.25\n");
  const Dataset eth3d = open_dataset(folder / "table_3");
  CHECK(eth3d.recording->format() == "tum");
  CHECK(eth3d.recording->intrinsics().fx == 726.2);
  CHECK(eth3d.recording->intrinsics().cy == 15.25);
  CHECK(eth3d.recording->intrinsics().width == 40);
  CHECK(eth3d.recording->load(0).frame->depth.at<float>(3, 3) == 1);
  folder.write("table_3/calibration.txt", "726.2 726.3 20.5\n");
  CHECK(contains(input_error([&] { open_dataset(folder / "table_3"); }), "fx fy cx cy"));
  write_lists("rgbd_bonn_balloon");
  const Dataset bonn = open_dataset(folder / "rgbd_bonn_balloon");
  CHECK(bonn.recording->intrinsics().fx == 542.822841);
  CHECK(contains(bonn.recording->assumptions()[0], "Bonn's"));
}

TEST_CASE("a folder that fits two layouts is not guessed at") {
  const TemporaryFolder folder("fr3_mixed");
  write_plain(folder);
  folder.write("camera.yaml", "width: 40\nheight: 30\n" + kCamera);
  folder.write("rgb.txt", "1.0 colour/a.jpg\n");
  folder.write("depth.txt", "1.0 depth/a.png\n");
  const std::string message = open_error(folder);
  CHECK(contains(message,
                 "could be of two layouts, tum (rgb.txt and depth.txt, or associations.txt) and plain"));
  CHECK(contains(message, "--format"));
  CHECK(open_dataset(folder.path(), {.format = "plain"}).recording->count() == 2);
  CHECK(open_dataset(folder.path(), {.format = "tum"}).recording->count() == 1);
}
