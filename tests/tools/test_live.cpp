// surefield run on frames as they come, sent by the programs of examples/.
#include <signal.h>

#include <cstdlib>
#include <set>
#include <sstream>

#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/io/trajectory_file.h"
#include "engine/synth/synthetic_recording.h"
#include "tests/support/device.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr double kUnit = 1.0 / 5000;

/// The camera of write_tum() as senders take it on the command line.
struct Sequence {
  Intrinsics camera;
  std::string intrinsics() const {
    std::ostringstream text;
    text.precision(17);
    text << camera.fx << " " << camera.fy << " " << camera.cx << " " << camera.cy;
    return text.str();
  }
};

/// Writes a short synthetic sequence in the layout of TUM.
Sequence write_tum(const TemporaryFolder& folder, int frames) {
  const SyntheticRecording recording(testing::device_options(),
                                     {.width = 64, .height = 48, .frames = frames});
  const Sequence sequence{recording.intrinsics()};
  std::filesystem::create_directories(folder / "rgb");
  std::filesystem::create_directories(folder / "depth");
  std::ostringstream colours, depths, pairs, camera;
  for (int i = 0; i < frames; ++i) {
    const Frame frame = recording.load(i).frame.value();
    cv::Mat steps;
    frame.depth.convertTo(steps, CV_16UC1, 1 / kUnit);
    const std::string name = std::to_string(i) + ".png", stamp = std::to_string(100 + i) + ".25";
    write_png(folder / ("rgb/" + name), frame.colour);
    write_png(folder / ("depth/" + name), steps);
    colours << stamp << " rgb/" << name << "\n";
    depths << stamp << " depth/" << name << "\n";
    pairs << stamp << " " << (folder / ("rgb/" + name)).string() << " " << stamp << " "
          << (folder / ("depth/" + name)).string() << "\n";
  }
  folder.write("rgb.txt", colours.str());
  folder.write("depth.txt", depths.str());
  folder.write("pairs", pairs.str());
  const Intrinsics& k = sequence.camera;
  camera.precision(17);
  camera << "width: " << k.width << "\nheight: " << k.height << "\nfx: " << k.fx << "\nfy: " << k.fy
         << "\ncx: " << k.cx << "\ncy: " << k.cy << "\ndepth_unit: " << kUnit << "\n";
  folder.write("camera.yaml", camera.str());
  return sequence;
}

/// The arguments of a short run with `source` in the place of its dataset.
std::vector<std::string> run_over(const std::vector<std::string>& source, const std::filesystem::path& out,
                                  int frames = 0) {
  std::vector<std::string> arguments = short_run(out, frames);
  arguments.erase(arguments.begin() + 1, arguments.begin() + 3);
  arguments.insert(arguments.begin() + 1, source.begin(), source.end());
  return arguments;
}

std::string as_command(const std::vector<std::string>& arguments) {
  std::string command = SUREFIELD_PROGRAM;
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  if (const char* device = std::getenv("SUREFIELD_DEVICE"))
    command += " --device '" + std::string(device) + "'";
  return command;
}

std::vector<nlohmann::json> lines_of(const std::filesystem::path& file) {
  std::vector<nlohmann::json> lines;
  std::istringstream text(read_file(file));
  for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

bool has_python() {
  return std::system("python3 -c pass 2>/dev/null") == 0;
}

}  // namespace

TEST_CASE("a stream of which every frame counts gives what the folder gives, bit for bit") {
  const TemporaryFolder folder("clip");
  const Sequence sequence = write_tum(folder, 5);
  const std::string clip = folder.path().string(), quiet = " 2>'" + (folder / "err").string() + "'";
  auto arguments = run_over({"--dataset", clip, "--depth-delay", "0"}, folder / "folder");
  REQUIRE(surefield_command(arguments, folder.path()).code == 0);
  std::vector<std::pair<std::string, std::string>> senders = {
      {"c", SUREFIELD_SEND_TUM " '" + (folder / "pairs").string() + "' 64 48 " + sequence.intrinsics()}};
  if (has_python())
    senders.emplace_back("python", "python3 " SUREFIELD_SOURCE_DIR "/examples/send_tum.py '" + clip + "' - " +
                                       sequence.intrinsics());
  else
    MESSAGE("skipped: send_tum.py, as there is no python3");
  for (const auto& named : senders) {
    const std::string &name = named.first, &sender = named.second;
    CAPTURE(name);
    const std::string poses = (folder / (name + ".jsonl")).string();
    arguments = run_over({"--live", "-", "--poses", poses}, folder / name);
    const std::string command = sender + " | " + as_command(arguments) + quiet + " >/dev/null";
    REQUIRE_MESSAGE(std::system(command.c_str()) == 0, read_file(folder / "err"));
    for (const char* file : {"trajectory.txt", "trajectory_online.txt", "keyframes.txt", "map.ply"}) {
      CAPTURE(file);
      CHECK(read_file(folder / "folder" / file) == read_file(folder / name / file));
    }
    const nlohmann::json json = read_json(folder / name / "metrics.json");
    CHECK(json["status"] == "completed");
    CHECK(json["live"] == nullptr);
    CHECK(json["dataset"]["path"] == nullptr);
    CHECK(json["frames"]["total"] == nullptr);
    CHECK(json["frames"]["fed"] == 5);
    CHECK_FALSE(contains(read_file(folder / "err"), "the sender went away"));

    const auto lines = lines_of(poses);
    const Trajectory online = read_trajectory(folder / name / "trajectory_online.txt");
    const std::set<std::string> states = {"good", "poor", "lost"};
    REQUIRE(lines.size() == 6);
    for (std::size_t i = 0; i < 5; ++i) {
      CHECK(lines[i]["index"] == i);
      CHECK(lines[i]["stamp"] == 100.25 + static_cast<double>(i));
      CHECK(states.contains(lines[i]["state"].get<std::string>()));
      CHECK(lines[i]["map_revision"] >= 0);
      CHECK(lines[i]["camera_to_world"].size() == 7);
    }
    CHECK(lines[0]["keyframe"] == true);
    CHECK(lines[1]["keyframe"] == false);
    const Eigen::Vector3d place = online[1].camera_to_world.translation();
    for (int axis = 0; axis < 3; ++axis)
      CHECK(lines[1]["camera_to_world"][axis].get<double>() == doctest::Approx(place[axis]).epsilon(1e-5));
    CHECK(lines[5]["state"] == "ended");
  }
}

TEST_CASE("a camera over a socket: the newest frame wins, poses come back, and its end is the run's") {
  const TemporaryFolder folder;
  const std::string place = (folder / "s").string();
  Program program(run_over({"--live", "unix:" + place}, folder / "out"), folder.path());
  wait_for(folder / "stderr.txt", "waiting for a sender at unix:" + place);
  const std::string sender =
      SUREFIELD_SEND_CAMERA " '" + place + "' 25 >'" + (folder / "poses").string() + "'";
  CHECK(std::system(sender.c_str()) == 0);
  REQUIRE_MESSAGE(program.wait() == 0, program.err());
  CHECK(contains(program.out(), "live             25 frames came"));
  CHECK(contains(program.out(), "from arrival"));
  CHECK(contains(program.out(), "from stamp"));
  const nlohmann::json json = read_json(folder / "out/metrics.json");
  CHECK(json["status"] == "completed");
  CHECK(json["dataset"]["format"] == "live");
  CHECK(json["dataset"]["name"] == "wall");
  const nlohmann::json& live = json["live"];
  CHECK(live["arrived"] == 25);
  CHECK(live["dropped"].get<int>() + json["frames"]["fed"].get<int>() +
            json["frames"]["skipped"].get<int>() ==
        25);
  CHECK(live["rate_hz"].get<double>() > 0);
  for (const char* kind : {"latency_ms", "stamp_latency_ms"}) {
    CHECK(live[kind]["median"].get<double>() > 0);
    CHECK(live[kind]["p95"] >= live[kind]["median"]);
  }
  const auto poses = lines_of(folder / "poses");
  CHECK(poses.size() == json["frames"]["fed"].get<std::size_t>() + 1);
  REQUIRE(poses.size() >= 2);
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) CHECK(poses[i]["index"] > poses[i - 1]["index"]);
  CHECK(poses[poses.size() - 2]["index"] == 24);  // that of the newest, whatever was dropped before
  CHECK(poses.back()["state"] == "ended");
  CHECK(json["images"]["frames"].get<int>() > 0);  // of keyframes that were kept
}

TEST_CASE("Ctrl-C ends a live run, and a wait for a sender, and saves what there is") {
  const TemporaryFolder folder;
  const std::string place = (folder / "s").string();
  {
    Program program(run_over({"--live", "unix:" + place}, folder / "nothing"), folder.path());
    wait_for(folder / "stderr.txt", "waiting for a sender");
    program.signal(SIGINT);
    CHECK(program.wait() == 130);
    CHECK_FALSE(std::filesystem::exists(place));
    CHECK_FALSE(std::filesystem::exists(folder / "nothing"));
  }
  std::filesystem::remove(folder / "stderr.txt");
  Program program(run_over({"--live", "unix:" + place}, folder / "out"), folder.path());
  wait_for(folder / "stderr.txt", "waiting for a sender");
  // It would send for an hour, and ends when nobody listens any more.
  const std::string sender = SUREFIELD_SEND_CAMERA " '" + place + "' 100000 >/dev/null &";
  CHECK(std::system(sender.c_str()) == 0);
  wait_for(folder / "out.partial/log.txt", "frame ");
  program.signal(SIGINT);
  CHECK(program.wait() == 130);
  const nlohmann::json json = read_json(folder / "out/metrics.json");
  CHECK(json["status"] == "interrupted");
  CHECK(read_trajectory(folder / "out/trajectory.txt").size() == json["frames"]["fed"]);
  CHECK(json["live"]["arrived"].get<int>() > 0);
}

TEST_CASE("what is no stream is refused by its message, and a stream that breaks is saved up to there") {
  const TemporaryFolder folder("clip");
  const Sequence sequence = write_tum(folder, 3);
  const auto run_on = [&](const std::string& sender, const std::string& out) {
    const std::string command = sender + " | " + as_command(run_over({"--live", "-"}, folder / out)) +
                                " 2>'" + (folder / "err").string() + "' >/dev/null";
    return WEXITSTATUS(std::system(command.c_str()));
  };
  CHECK(run_on("echo 'RIFF of another kind'", "no_stream") == 2);
  CHECK(contains(read_file(folder / "err"), "message 1, the header of the stream: begins with \"RIFF\""));
  CHECK_FALSE(std::filesystem::exists(folder / "no_stream"));
  const std::string sender =
      SUREFIELD_SEND_TUM " '" + (folder / "pairs").string() + "' 64 48 " + sequence.intrinsics();
  CHECK(run_on("(" + sender + " | head -c -8; printf garbage!)", "broken") == 2);
  CHECK(contains(read_file(folder / "err"), "message 5 of the stream begins with \"garb\""));
  CHECK(read_json(folder / "broken/metrics.json")["status"] == "failed");
  CHECK(read_trajectory(folder / "broken/trajectory.txt").size() == 3);
  CHECK(run_on(sender + " | head -c -20", "cut") == 0);
  CHECK(contains(read_file(folder / "err"), "the sender went away"));
  CHECK(read_json(folder / "cut/metrics.json")["status"] == "completed");
  CHECK(read_trajectory(folder / "cut/trajectory.txt").size() == 2);
}

TEST_CASE("a replay at its own speed that has time enough changes nothing, one that has none drops frames") {
  const TemporaryFolder folder("clip");
  write_tum(folder, 3);
  // Nothing takes the place of the second of two frames, however slow the machine is.
  const std::string clip = folder.path().string();
  auto arguments = run_over({"--dataset", clip, "--depth-delay", "0"}, folder / "plain", 2);
  REQUIRE(surefield_command(arguments, folder.path()).code == 0);
  arguments =
      run_over({"--dataset", clip, "--depth-delay", "0", "--realtime", "--speed", "2"}, folder / "slow", 2);
  const Outcome slow = surefield_command(arguments, folder.path());
  REQUIRE_MESSAGE(slow.code == 0, slow.err);
  CHECK(contains(slow.out, "; 0 were dropped"));
  CHECK(read_file(folder / "plain/trajectory.txt") == read_file(folder / "slow/trajectory.txt"));
  CHECK(read_file(folder / "plain/map.ply") == read_file(folder / "slow/map.ply"));
  arguments =
      run_over({"--dataset", clip, "--depth-delay", "0", "--realtime", "--speed", "1e6"}, folder / "fast");
  REQUIRE(surefield_command(arguments, folder.path()).code == 0);
  const nlohmann::json live = read_json(folder / "fast/metrics.json")["live"];
  CHECK(live["arrived"] == 3);
  CHECK(live["dropped"].get<int>() > 0);  // while the first one was mapped all others came
}

TEST_CASE("sources that exclude each other, and addresses that are none, are refused") {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::vector<std::string>& source) {
    const Outcome outcome = surefield_command(run_over(source, folder / "out"), folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(refusal({"--live", "-", "--dataset", "synthetic"}), "--live"));
  CHECK(contains(refusal({"--live", "-", "--realtime"}), "--realtime"));
  CHECK(contains(refusal({"--live", "-", "--assume-depth-unit", "0.001"}), "--assume-depth-unit"));
  CHECK(contains(refusal({"--live", "webcam"}), "unix:PATH"));
  CHECK(contains(refusal({"--dataset", "synthetic", "--realtime", "--speed", "0"}), "--speed"));
  CHECK(contains(refusal({"--dataset", "synthetic", "--poses", "/no/such/folder/poses"}),
                 "/no/such/folder/poses"));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}
