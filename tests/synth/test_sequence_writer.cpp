#include "engine/synth/sequence_writer.h"

#include <doctest/doctest.h>

#include "engine/formats/triangle_mesh.h"
#include "engine/io/files.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
#include "tests/support/device.h"
#include "tests/support/input_files.h"

using namespace surefield;
using surefield::test::TemporaryFolder;

namespace {

SyntheticRecording tiny(int frames = 3) {
  return SyntheticRecording(testing::device_options(),
                            {.width = 64, .height = 48, .frames = frames, .seed = 2});
}

void write_all(const std::filesystem::path& folder, SequenceLayout layout,
               const SyntheticRecording& recording, int frames) {
  SequenceWriter writer(folder, layout, recording);
  for (int i = 0; i < frames; ++i) writer.write(i);
  writer.finish();
}

void check_same_camera(const Intrinsics& a, const Intrinsics& b) {
  CHECK(a.width == b.width);
  CHECK(a.height == b.height);
  CHECK(a.fx == b.fx);
  CHECK(a.fy == b.fy);
  CHECK(a.cx == b.cx);
  CHECK(a.cy == b.cy);
}

}  // namespace

TEST_CASE("a sequence in the Replica layout reads back with its camera, poses, depth and colour") {
  const TemporaryFolder folder;
  const SyntheticRecording recording = tiny();
  write_all(folder / "office", SequenceLayout::Replica, recording, 3);
  const auto read = open_dataset(folder / "office");
  CHECK(read.recording->format() == "replica");
  REQUIRE(read.recording->count() == 3);
  check_same_camera(read.recording->intrinsics(), recording.intrinsics());
  REQUIRE(read.ground_truth);
  REQUIRE(read.ground_truth->size() == 3);
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    CHECK((*read.ground_truth)[at].camera_to_world.matrix().isApprox(
        recording.ground_truth()[at].camera_to_world.matrix(), 1e-10));
    const Frame stored = read.recording->load(i).frame.value(), made = recording.load(i).frame.value();
    CHECK(cv::norm(stored.depth, made.depth, cv::NORM_INF) < 0.51 / 6553.5);
    CHECK(cv::norm(stored.colour, made.colour, cv::NORM_L1) / (3 * 64 * 48) < 3);
  }
}

TEST_CASE("a sequence in the TUM layout reads back, with stamps apart and a true pose for each") {
  const TemporaryFolder folder;
  const SyntheticRecording recording(testing::device_options(), {.width = 64,
                                                                 .height = 48,
                                                                 .frames = 3,
                                                                 .seed = 2,
                                                                 .sensor = SensorKind::Kinect,
                                                                 .moving_object = true});
  write_all(folder / "freiburg1_office", SequenceLayout::Tum, recording, 3);
  const auto read = open_dataset(folder / "freiburg1_office");  // a name that means another camera elsewhere
  CHECK(read.recording->format() == "tum");
  REQUIRE(read.recording->count() == 3);
  check_same_camera(read.recording->intrinsics(), recording.intrinsics());
  const Trajectory& truth = *read.ground_truth;
  REQUIRE(truth.size() == 6);
  for (int i = 0; i < 3; ++i) {
    const double colour = recording.colour_timestamp(i), depth = recording.timestamp(i);
    CHECK(colour - depth == doctest::Approx(0.006));
    CHECK(std::abs(read.recording->timestamp(i) - colour) < 1e-6);
    const auto at = static_cast<std::size_t>(2 * i);
    CHECK(truth[at].camera_to_world.isApprox(recording.true_pose(depth), 1e-7));
    CHECK(truth[at + 1].camera_to_world.isApprox(recording.true_pose(colour), 1e-7));
    const Frame stored = read.recording->load(i).frame.value(), made = recording.load(i).frame.value();
    CHECK(cv::norm(stored.depth, made.depth, cv::NORM_INF) < 0.51 / 5000);
    CHECK(cv::norm(stored.colour, made.colour, cv::NORM_INF) == 0);
  }
}

TEST_CASE("the mesh lies on the surfaces that the frames show") {
  const TemporaryFolder folder;
  const SyntheticRecording recording = tiny(1);
  write_all(folder / "office", SequenceLayout::Replica, recording, 1);
  const TriangleMesh mesh = read_mesh(folder / "office/mesh.ply");
  CHECK(mesh.triangles.size() > 10000);
  CHECK(mesh.colours.size() == mesh.vertices.size());
  const Frame frame = recording.load(0).frame.value();
  const Pose to_world = recording.ground_truth().front().camera_to_world;
  const Intrinsics k = recording.intrinsics();
  for (int v = 3; v < 48; v += 10) {
    for (int u = 3; u < 64; u += 10) {
      const double z = frame.depth.at<float>(v, u);
      const Eigen::Vector3f point =
          (to_world * Eigen::Vector3d((u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z)).cast<float>();
      float nearest = 1;
      for (const auto& vertex : mesh.vertices) nearest = std::min(nearest, (vertex - point).norm());
      CHECK(nearest < 0.08f);  // vertices are up to 0.1 m apart
    }
  }
}

TEST_CASE("a sequence that was broken off reads back with the frames it has") {
  const TemporaryFolder folder;
  const SyntheticRecording recording = tiny();
  write_all(folder / "office", SequenceLayout::Replica, recording, 2);
  const auto read = open_dataset(folder / "office");
  CHECK(read.recording->count() == 2);
  CHECK(read.ground_truth->size() == 2);
  CHECK(read_file(folder / "office/synth.json").find("\"complete\": false") != std::string::npos);
}

TEST_CASE("an earlier sequence is replaced, any other folder with files is refused and left alone") {
  const TemporaryFolder folder;
  const SyntheticRecording recording = tiny();
  write_all(folder / "office", SequenceLayout::Replica, recording, 3);
  write_all(folder / "office", SequenceLayout::Replica, recording, 1);
  CHECK(open_dataset(folder / "office").recording->count() == 1);

  folder.write("holiday/results/frame000000.jpg", "mine");
  CHECK_THROWS_AS(SequenceWriter(folder / "holiday", SequenceLayout::Replica, recording), InputError);
  CHECK(read_file(folder / "holiday/results/frame000000.jpg") == "mine");
}
