// Constructed folders: every way in which a sequence can be wrong, and the small layouts that must still
// work.
#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "engine/io/files.h"
#include "engine/sources/open_dataset.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

constexpr const char* kIdentityRows = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

void write_images(const TemporaryFolder& folder, const std::string& colour, const std::string& depth,
                  cv::Size size = {640, 480}) {
  std::filesystem::create_directories((folder / colour).parent_path());
  std::filesystem::create_directories((folder / depth).parent_path());
  cv::imwrite((folder / colour).string(), cv::Mat(size, CV_8UC3, cv::Scalar(10, 100, 200)));  // BGR
  cv::imwrite((folder / depth).string(), cv::Mat(size, CV_16UC1, cv::Scalar(5000)));
}

/// Three frames; the depth image of the second has no colour partner nearer than that of the first.
void write_tum(const TemporaryFolder& folder) {
  write_images(folder, "rgb/a.png", "depth/a.png");
  folder.write("rgb.txt", "# comment\n1.00 rgb/a.png\n1.01 rgb/a.png\n2.00 rgb/a.png\n");
  folder.write("depth.txt", "1.005 depth/a.png\n2.03 depth/a.png\n");
}

void write_sevenscenes(const TemporaryFolder& folder, int count) {
  for (int i = 0; i < count; ++i) {
    const std::string name = fmt::format("frame-{:06}", i);
    write_images(folder, name + ".color.png", name + ".depth.png");
    folder.write(name + ".pose.txt", kIdentityRows);
  }
}

void write_replica(const TemporaryFolder& folder, const std::string& calibration) {
  write_images(folder, "results/frame000000.jpg", "results/depth000000.png", {12, 8});
  folder.write("traj.txt", "1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1\n");
  folder.write("cam_params.json", calibration);
}

const std::string kCalibration =
    R"({"camera": {"w": 12, "h": 8, "fx": 10, "fy": 11, "cx": 5.5, "cy": 3.5, "scale": 1000}})";

void truncate(const std::filesystem::path& file, double fraction) {
  std::filesystem::resize_file(
      file, static_cast<std::uintmax_t>(static_cast<double>(std::filesystem::file_size(file)) * fraction));
}

std::string open_error(const TemporaryFolder& folder, const std::string& format = "auto") {
  return input_error([&] { open_dataset(folder.path(), {.format = format}); });
}

/// The first warning of a dataset that can be opened.
std::string warning(const TemporaryFolder& folder) {
  const auto dataset = open_dataset(folder.path());
  REQUIRE_FALSE(dataset.recording->warnings().empty());
  return dataset.recording->warnings().front();
}

}  // namespace

TEST_CASE("a folder that is missing, empty, of another layout or of an unknown format is named") {
  const TemporaryFolder folder;
  CHECK(contains(input_error([&] { open_dataset(folder / "nowhere"); }), "nowhere: there is no such folder"));
  const std::string message = open_error(folder);
  for (const char* part :
       {"no known dataset layout here", "rgb.txt", "results/frame", "frame-000000.color"}) {
    CHECK(contains(message, part));
  }
  CHECK(contains(open_error(folder, "tum"),
                 "is no sequence of format tum (tum has rgb.txt and depth.txt, or associations.txt)"));
  CHECK(contains(open_error(folder, "kitti"),
                 "\"kitti\"; use one of auto, tum, replica, sevenscenes, scannet, icl, plain"));
}

TEST_CASE("TUM: a depth image may serve two colour images, a colour image without depth is left out") {
  const TemporaryFolder folder("own_fr3_test");
  write_tum(folder);
  const auto dataset = open_dataset(folder.path());
  CHECK(dataset.recording->count() == 2);
  CHECK(dataset.recording->timestamp(1) == 1.01);
  REQUIRE(dataset.recording->warnings().size() == 1);
  CHECK(contains(dataset.recording->warnings().front(), "1 of 3 colour images"));
  CHECK(!dataset.ground_truth);
  CHECK(dataset.recording->intrinsics().fx == 535.4);
  const LoadedFrame loaded = dataset.recording->load(0);
  REQUIRE(loaded.frame);
  CHECK(loaded.frame->colour.at<cv::Vec3b>(0, 0) == cv::Vec3b(200, 100, 10));
  CHECK(loaded.frame->depth.at<float>(479, 639) == 1.0f);
}

TEST_CASE("TUM: seconds added to the stamps of depth images change which colour images they belong to") {
  const TemporaryFolder folder("own_fr3_test");
  write_tum(folder);
  const auto later = open_dataset(folder.path(), {.depth_delay = -0.02});
  REQUIRE(later.recording->count() == 2);
  CHECK(later.recording->timestamp(0) == 1.0);
  CHECK(later.recording->depth_timestamp(0) == doctest::Approx(0.985));
  CHECK(later.recording->timestamp(1) == 2.0);
  CHECK(later.recording->depth_timestamp(1) == doctest::Approx(2.01));
  CHECK(later.recording->load(0).frame->depth_after == doctest::Approx(-0.015));
}

TEST_CASE("TUM: the camera comes from the folder's name or from cam_params.json") {
  const TemporaryFolder unknown("recording");
  write_tum(unknown);
  CHECK(contains(open_error(unknown), "camera is unknown"));
  unknown.write("cam_params.json", kCalibration);
  CHECK(open_dataset(unknown.path()).recording->intrinsics().fy == 11);
  const TemporaryFolder second("rgbd_dataset_freiburg2_desk");
  write_tum(second);
  CHECK(open_dataset(second.path()).recording->intrinsics().fx == 520.9);
}

TEST_CASE("TUM: camera.yaml goes before the folder's name, and each of its keys is checked") {
  const TemporaryFolder folder("own_fr1_recording");
  write_tum(folder);
  const std::string text = "width: 640\nheight: 480\nfx: 500\nfy: 501\ncx: 319\ncy: 239\n";
  const auto error = [&](const std::string& content) {
    folder.write("camera.yaml", content);
    return open_error(folder);
  };
  CHECK(error(text + "depth_unit: 0.001\ndistortion: [0.1, 0, 0, 0, 0]\n").empty());
  const auto dataset = open_dataset(folder.path());
  CHECK(dataset.recording->intrinsics().fx == 500);
  CHECK(dataset.recording->intrinsics().fy == 501);
  CHECK(dataset.recording->intrinsics().width == 640);
  CHECK(dataset.recording->intrinsics().cy == 239);
  CHECK(dataset.recording->depth_unit() == 0.001);
  REQUIRE(dataset.recording->load(0).frame);
  CHECK(dataset.recording->load(0).frame->depth.at<float>(240, 320) == 5.0f);
  CHECK(contains(error(text), "camera.yaml: depth_unit is missing"));
  CHECK(contains(error(text + "depth_unit: 0\n"), "camera.yaml:7: depth_unit must be"));
  CHECK(contains(error(text + "depth_scale: 1000\n"), "camera.yaml:7: unknown key depth_scale"));
  CHECK(contains(error("height: 480\nfx: 1\nfy: 1\ncx: 1\ncy: 1\ndepth_unit: 1\n"), "both or not at all"));
  // Without a size it is that of the images.
  CHECK(error("fx: 1\nfy: 1\ncx: 1\ncy: 1\ndepth_unit: 1\n").empty());
  CHECK(open_dataset(folder.path()).recording->intrinsics().height == 480);
}

TEST_CASE("TUM: broken lists are named with the line") {
  const TemporaryFolder folder("fr1_broken");
  write_tum(folder);
  folder.write("rgb.txt", "# c\n1.0 rgb/a.png\nnonsense\n");
  CHECK(contains(open_error(folder), "rgb.txt:3: expected \"timestamp file\""));
  folder.write("rgb.txt", "# nothing\n");
  CHECK(contains(open_error(folder), "rgb.txt: lists no image"));
  folder.write("rgb.txt", "900.0 rgb/a.png\n");
  CHECK(contains(open_error(folder), "within 0.02 s"));
  folder.write("rgb.txt", "1.0 rgb/a.png\n");
  folder.write("groundtruth.txt", "1.0 0 0 0 0 0 0\n");
  CHECK(contains(warning(folder), "groundtruth.txt:1"));
}

TEST_CASE("missing, damaged and wrong images are problems of one frame") {
  const TemporaryFolder folder;
  write_sevenscenes(folder, 6);
  std::filesystem::remove(folder / "frame-000001.color.png");
  truncate(folder / "frame-000002.depth.png", 0.5);
  folder.write("frame-000003.color.png", "");
  cv::imwrite((folder / "frame-000004.depth.png").string(), cv::Mat(480, 640, CV_8UC1, cv::Scalar(3)));
  cv::imwrite((folder / "frame-000005.color.png").string(), cv::Mat(48, 64, CV_8UC3));
  const auto dataset = open_dataset(folder.path());
  REQUIRE(dataset.recording->count() == 6);
  CHECK(dataset.recording->load(0).frame);
  const std::vector<std::string> expected = {
      "",
      "frame-000001.color.png: no such file",
      "frame-000002.depth.png: is not a readable image",
      "frame-000003.color.png: is not a readable image",
      "frame-000004.depth.png: is no depth image",
      "frame-000005.color.png: is 64 x 48 pixels, the calibration is for 640 x 480"};
  for (int i = 1; i < 6; ++i) {
    const LoadedFrame loaded = dataset.recording->load(i);
    CHECK_FALSE(loaded.frame);
    CHECK_MESSAGE(contains(loaded.problem, expected[static_cast<std::size_t>(i)]), loaded.problem);
  }
}

TEST_CASE("7-Scenes: 65535 is invalid, jpg is accepted, a broken pose is named") {
  const TemporaryFolder folder;
  write_images(folder, "frame-000003.color.jpg", "frame-000003.depth.png");
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(1500));
  depth(cv::Rect(100, 100, 50, 50)).setTo(65535);
  cv::imwrite((folder / "frame-000003.depth.png").string(), depth);
  const auto dataset = open_dataset(folder.path());
  CHECK(dataset.recording->count() == 1);
  CHECK(dataset.recording->timestamp(0) == 3.0);
  CHECK(!dataset.ground_truth);
  const LoadedFrame loaded = dataset.recording->load(0);
  REQUIRE(loaded.frame);
  // Registered to the colour camera, depth changes by less than two centimetres; the border is not covered.
  CHECK(loaded.frame->depth.at<float>(0, 0) == 0);
  CHECK(loaded.frame->depth.at<float>(240, 320) == doctest::Approx(1.5).epsilon(0.012));
  CHECK(cv::countNonZero(loaded.frame->depth > 2) == 0);
  folder.write("frame-000003.pose.txt", "1 0 0 0 0 2 0 0 0 0 1 0 0 0 0 1");
  CHECK(contains(warning(folder), "frame-000003.pose.txt: expected a rigid 4 x 4"));
}

TEST_CASE("a JPEG that was cut off is damaged, not grey below") {
  const TemporaryFolder folder;
  write_replica(folder, kCalibration);
  const auto dataset = open_dataset(folder.path());
  CHECK(dataset.recording->load(0).frame);
  truncate(folder / "results/frame000000.jpg", 0.9);
  CHECK(contains(dataset.recording->load(0).problem, "frame000000.jpg: is not a readable image"));
}

TEST_CASE("Replica: the calibration is found here or in the parent folder; each of its keys is checked") {
  const TemporaryFolder folder;
  write_replica(folder, kCalibration);
  CHECK(open_dataset(folder.path()).ground_truth->front().camera_to_world.translation().z() == 7);
  std::filesystem::rename(folder / "cam_params.json", folder.path().parent_path() / "cam_params.json");
  CHECK(open_dataset(folder.path() / "").recording->intrinsics().fy == 11);
  write_images(folder, "results/frame000000.png", "results/depth000000.png", {12, 8});
  std::filesystem::remove(folder / "results/frame000000.jpg");
  CHECK(open_dataset(folder.path()).recording->load(0).frame);
  std::filesystem::remove(folder.path().parent_path() / "cam_params.json");
  CHECK(contains(open_error(folder), "cam_params.json is missing"));
  folder.write("cam_params.json", R"({"camera": {"w": 12, "h": 8, "fx": 10, "fy": 10, "cx": 5, "cy": 3}})");
  CHECK(contains(open_error(folder), "\"scale\" is missing"));
  folder.write("cam_params.json", R"({"camera": {"w": 12.5}})");
  CHECK(contains(open_error(folder), "\"w\" must be a whole number"));
  folder.write("cam_params.json", "{\n");
  CHECK(contains(open_error(folder), "is not valid JSON"));
  folder.write("cam_params.json", kCalibration);
  folder.write("traj.txt", "1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1\n1 2 3\n");
  CHECK(contains(warning(folder), "traj.txt:2: expected a rigid 4 x 4"));
}
