// surefield inspect: its verdicts and exit codes, on small recordings that are right or wrong in one thing.
#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "engine/io/images.h"
#include "tests/eval/planes.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr double kUnit = 0.0002;  // metres a step of the depth images that are written

/// How a recording is written.
struct Told {
  double depth_unit = kUnit;  ///< what camera.yaml says
  double focal = 1;           ///< factor on the focal lengths
  bool truth = true;
  double truth_delay = 0;    ///< seconds, added to the stamps of the truth
  cv::Size depth_size = {};  ///< of the depth images, where another than that of colour
  int depth_every = 1;       ///< frames to the next depth image
};

/// Writes a recording as TUM's layout.
void write_recording(const TemporaryFolder& folder, const PlanesRecording& planes, const Told& told) {
  std::string rgb, depth, truth;
  std::filesystem::create_directories(folder / "rgb");
  std::filesystem::create_directories(folder / "depth");
  for (int i = 0; i < planes.count(); ++i) {
    const Frame frame = *planes.load(i).frame;
    const std::string line = fmt::format("{:.6f} {{}}/{:03}.png\n", planes.timestamp(i), i);
    write_png(folder / fmt::format("rgb/{:03}.png", i), frame.colour);
    rgb += fmt::format(fmt::runtime(line), "rgb");
    if (i % told.depth_every != 0) continue;
    cv::Mat stored;
    frame.depth.convertTo(stored, CV_16U, 1 / kUnit);
    if (!told.depth_size.empty())
      cv::resize(stored.clone(), stored, told.depth_size, 0, 0, cv::INTER_NEAREST);
    write_png(folder / fmt::format("depth/{:03}.png", i), stored);
    depth += fmt::format(fmt::runtime(line), "depth");
  }
  for (const StampedPose& pose : *planes.ground_truth()) {
    const auto& t = pose.camera_to_world.translation();
    const Eigen::Quaterniond q(pose.camera_to_world.linear());
    truth += fmt::format("{:.6f} {} {} {} {} {} {} {}\n", pose.timestamp + told.truth_delay, t.x(), t.y(),
                         t.z(), q.x(), q.y(), q.z(), q.w());
  }
  const Intrinsics& k = planes.told;
  folder.write("rgb.txt", rgb);
  folder.write("depth.txt", depth);
  if (told.truth) folder.write("groundtruth.txt", truth);
  folder.write("camera.yaml",
               fmt::format("width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\ndepth_unit: {}\n", k.width,
                           k.height, told.focal * k.fx, told.focal * k.fy, k.cx, k.cy, told.depth_unit));
}

/// Inspects such a recording.
Outcome inspected(const Told& told, const PlanesRecording& planes = PlanesRecording(24)) {
  const TemporaryFolder data("planes"), folder;
  write_recording(data, planes, told);
  return surefield_command({"inspect", data.path().string(), "--json", folder / "inspection.json"},
                           folder.path());
}

}  // namespace

TEST_CASE("inspect of a recording that is as told: fits, exit code 0, and what was not checked is listed") {
  const TemporaryFolder data("planes"), folder;
  write_recording(data, PlanesRecording(24), {});
  const Outcome outcome = surefield_command(
      {"inspect", data.path().string(), "--json", folder / "inspection.json"}, folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.out);
  CHECK(contains(outcome.out, "fits             focal_length: x "));
  CHECK(contains(outcome.out, "fits             registration: "));
  CHECK(contains(outcome.out, "fits             poses: known for 24 of 24 frames"));
  CHECK_FALSE(contains(outcome.out, "DOES NOT FIT"));
  CHECK_FALSE(contains(outcome.out, "nothing wrong found"));
  const nlohmann::json json = read_json(folder / "inspection.json");
  CHECK(json["schema"] == "surefield-inspection");
  CHECK(json["findings"].empty());
  REQUIRE(json["verdicts"].size() == 13);
  CHECK(json["verdicts"][0]["subject"] == "files");
  CHECK(json["verdicts"][0]["verdict"] == "fits");
  CHECK(contains(json["verdicts"][0]["text"], "all of 24 frames"));
  CHECK(json["check"]["focal_length"]["judged"] == true);
  CHECK(json["check"]["focal_length"]["lower"].get<double>() < 1);
}

TEST_CASE("inspect without true poses says what it could not check") {
  const Outcome outcome = inspected({.truth = false});
  CHECK_MESSAGE(outcome.code == 0, outcome.out);
  CHECK(contains(outcome.out, "not checked      depth_scale: it takes true poses"));
  CHECK(contains(outcome.out, "not checked      poses: there are no true poses"));
}

TEST_CASE("inspect: all depth of a wrong size does not fit") {
  const Outcome outcome = inspected({.depth_size = {64, 48}});
  CHECK(outcome.code == 2);
  CHECK(
      contains(outcome.out, "DOES NOT FIT     files: 24 of 24 frames cannot be read; the first, frame 0: "));
  CHECK(contains(outcome.out, "is 64 x 48 pixels, the calibration is for 128 x 96"));
  CHECK(contains(outcome.out, "not checked      focal_length: no frame with depth can be read"));
}

TEST_CASE("inspect: f = 900 for 517 does not fit") {
  const Outcome outcome = inspected({.focal = 1.74});
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.out, "DOES NOT FIT     focal_length: the focal lengths look 1.7"));
}

TEST_CASE("inspect: a depth unit that is five times too small does not fit") {
  const Outcome outcome = inspected({.depth_unit = kUnit / 5});
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.out, "DOES NOT FIT     depth_scale: depth looks "));
  CHECK(contains(outcome.out, "do the files use 1/5000 m?"));
}

TEST_CASE("inspect: a recording most of whose colour images have no depth does not fit") {
  const Outcome outcome = inspected({.depth_every = 6});
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.out,
                 "DOES NOT FIT     frames: 20 of 24 colour images have no depth image near them in time"));
}

TEST_CASE("inspect: true poses of another clock do not fit") {
  const Outcome outcome = inspected({.truth_delay = 1000});
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.out,
                 "DOES NOT FIT     poses: no pose of the truth is near a frame: clocks differ by 1000 s"));
}

TEST_CASE("inspect: where neither focal length nor registration could be judged, exit code 4") {
  /// One wall without edges, seen by a camera that stands still.
  class Wall : public PlanesRecording {
   public:
    using PlanesRecording::PlanesRecording;
    LoadedFrame load(int i) const override {
      LoadedFrame loaded = PlanesRecording::load(i);
      loaded.frame->colour.setTo(cv::Scalar::all(120));
      loaded.frame->depth.setTo(2.0f);
      return loaded;
    }
  };
  const TemporaryFolder data("wall"), folder;
  write_recording(data, Wall(12), {.truth = false});
  const Outcome outcome = surefield_command({"inspect", data.path().string()}, folder.path());
  CHECK_MESSAGE(outcome.code == 4, outcome.out);
  CHECK(contains(outcome.out, "not checked      focal_length: "));
  CHECK(contains(outcome.out, "not checked      registration: "));
}

TEST_CASE("[slow] inspect describes a clip, finds nothing wrong with it, and writes the same as JSON") {
  const auto clip = real_clip("replica_room0");
  if (clip.empty()) return;
  const TemporaryFolder folder;
  const Outcome outcome =
      surefield_command({"inspect", clip.string(), "--json", folder / "inspection.json"}, folder.path());
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.out, "replica_room0, format replica"));
  CHECK(contains(outcome.out, "20, 1200 x 680"));
  CHECK_FALSE(contains(outcome.out, "DOES NOT FIT"));
  const nlohmann::json json = read_json(folder / "inspection.json");
  CHECK(json["frames"] == 20);
  CHECK(json["stamps"]["are_indices"] == true);
  CHECK(json["posed_frames"] == 20);
  CHECK(json["depth"]["holes"].get<double>() < 0.01);
  CHECK(json["check"]["depth_scale"]["judged"] == true);
  CHECK(json["check"]["depth_scale"]["wrong"] == false);
  CHECK(json["findings"].empty());
}

TEST_CASE("inspect names what it cannot open") {
  const TemporaryFolder folder;
  const Outcome outcome = surefield_command({"inspect", folder.path().string()}, folder.path());
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "no known dataset layout"));
}

TEST_CASE("inspect lists the topics of a log, also of one without images") {
  const auto logs = real_clip("logs");
  if (logs.empty()) return;
  const TemporaryFolder folder;
  const Outcome outcome =
      surefield_command({"inspect", (logs / "topics_and_services.db3").string()}, folder.path());
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.out,
                 "topics           /add_two_ints/_service_event  example_interfaces/srv/AddTwoInts_Event, 6 "
                 "messages\n"));
  CHECK(contains(outcome.out,
                 "                 /parameter_events  rcl_interfaces/ParameterEvent, 7 messages\n"));
  CHECK(contains(outcome.err, "has no topic with colour images (those with images: none); it has "));
}
