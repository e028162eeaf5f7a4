// surefield run: the options; the work is in run_session.
#include <fmt/format.h>

#include <csignal>
#include <memory>

#include "engine/formats/map_file.h"
#include "engine/sources/camera_file.h"
#include "tools/run/run_film.h"
#include "tools/run/run_session.h"
#include "tools/run/run_viewer.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/ui_scale.h"

namespace surefield {

namespace {

constexpr const char* kRunExamples =
    "Writes into the folder of --out: trajectory.txt, trajectory_online.txt (each pose as it was when its\n"
    "frame came) and keyframes.txt (TUM format, camera to world), map.ply (the Gaussians; map.spz with\n"
    "--map-format spz), metrics.json, frames.csv and loops.csv (docs/evaluation.md), config.yaml (every\n"
    "setting as used), log.txt.\n"
    "They appear together when the run has ended; until then, and where it is killed, FOLDER.partial has "
    "what was\n"
    "saved every few keyframes. Ctrl-C, SIGTERM and SIGHUP end the run soon and save everything; a second "
    "one quits\n"
    "at once.\n"
    "\n"
    "Examples:\n"
    "  surefield run --dataset synthetic --out out/demo\n"
    "  surefield run --dataset rgbd_dataset_freiburg1_desk --out out/desk --frames 100 --scale 0.5\n"
    "  surefield run --dataset walk.mcap --out out/walk --colour-topic /camera/color/image_raw\n"
    "  surefield run --dataset Replica/room0 --out out/room0 --set gauss_newton.renders=5 --set seed=2\n"
    "  surefield run --dataset synthetic --out out/demo --film out/demo.mp4\n"
    "  surefield run --dataset synthetic --out out/demo --viewer\n"
    "  surefield run --dataset rgbd_dataset_freiburg1_desk --out out/desk --realtime --budget-ms 33\n"
    "  examples/send_tum.py rgbd_dataset_freiburg1_desk - | surefield run --live - --out out/desk\n"
    "  surefield run --live unix:/tmp/camera --out out/camera --viewer\n";

/// What --format may be here: the embedded sequence has a format of its own.
std::vector<std::string> run_formats() {
  std::vector<std::string> formats = known_formats();
  formats.push_back("synthetic");
  return formats;
}

std::string known_camera_list() {
  return fmt::format("{}", fmt::join(known_camera_names(), ", "));
}

int run_watched(const RunOptions& options) {
  catch_interrupts();
  std::signal(SIGPIPE, SIG_IGN);  // a closed output ends the run like Ctrl-C, see say()
  std::optional<RunFilm> film;
  RunObservers observers;
  if (!options.film.empty()) observers.push_back(&film.emplace(options));
  const int code = options.viewer ? run_with_viewer(options, observers) : run_session(options, observers);
  return code == kSuccess && film && film->failed() ? kFailure : code;
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* run =
      program.add_subcommand("run", "Tracks the camera and builds the map of a recorded sequence, or live");
  auto* dataset = run->add_option(
      "--dataset", options->dataset,
      "Folder of the sequence (or a .sens, .mcap, .db3 or .bag file), or \"synthetic\" for the embedded one");
  auto* live = run->add_option(
      "--live", options->live,
      "Frames as they come, instead of a dataset: - (standard input), unix:PATH or "
      "tcp:127.0.0.1:PORT, where a sender connects, or openni2[:URI], a camera (docs/live.md)");
  live->excludes(dataset);
  auto* realtime = run->add_flag(
      "--realtime", options->realtime,
      "Replays the dataset at its own speed; frames for which there is no time are dropped, as a "
      "camera's (docs/live.md)");
  run->add_option("--speed", options->speed, "With --realtime: times as fast as it was recorded")
      ->check(CLI::PositiveNumber)
      ->needs(realtime)
      ->capture_default_str();
  realtime->excludes(live);
  run->add_option("--out", options->out, "Folder of the results")->required();
  run->add_option(
      "--poses", options->poses,
      "Tells each pose at once, as a line of JSON, on standard output (-) or in a file (docs/live.md)");
  run->add_option("--budget-ms", options->budget_ms,
                  "Milliseconds that a frame may take before mapping steps are left out: the key budget_ms")
      ->check(CLI::NonNegativeNumber);
  run->add_option("--format", options->format, "Layout of the dataset")
      ->check(CLI::IsMember(run_formats()))
      ->capture_default_str();
  run->add_option("--map-format", options->map_format,
                  "How the map is stored: as 32-bit floats that any splat viewer opens, or compactly "
                  "(docs/formats.md)")
      ->check(CLI::IsMember(run_map_formats()))
      ->capture_default_str();
  run->add_option("--config", options->config,
                  "YAML file, or the name of a built-in one; default: the built-in one of the format");
  run->add_option("--set", options->assignments, "Sets one key, as in --set gauss_newton.renders=5")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  run->add_option("--frames", options->selection.frames, "Number of frames, at most; 0: all")
      ->capture_default_str();
  run->add_option("--start", options->selection.start, "Index of the first frame")->capture_default_str();
  run->add_option("--stride", options->selection.stride, "Takes every so many frames")->capture_default_str();
  run->add_option("--scale", options->selection.scale,
                  "Size of the images relative to the originals, up to 1")
      ->capture_default_str();
  run->add_option("--depth-delay", options->depth_delay,
                  "Seconds to add to the stamps of depth images that have their own (TUM) before they are "
                  "paired with colour images; default: estimated from the edges of both");
  run->add_option(
      "--assume-camera", options->assumed_camera,
      "The camera, instead of what the dataset says or implies: a file as camera.yaml, or one of " +
          known_camera_list() + " (docs/datasets.md)");
  run->add_option("--assume-depth-unit", options->assumed_depth_unit,
                  "Metres for one step of the depth images, instead of what the dataset says or implies")
      ->check(CLI::PositiveNumber);
  run->add_option(
      "--colour-topic", options->colour_topic,
      "Topic of the colour images in a log (.mcap, .db3, .bag), where the one that is found is another");
  run->add_option("--depth-topic", options->depth_topic, "The same of the depth images");
  run->add_option("--device", options->engine.device,
                  "Number or part of the name of the device, see surefield devices; default: the best");
  run->add_flag("--validate", options->engine.validate, "Runs under Vulkan's validation layer (slow)");
  run->add_option("--film", options->film,
                  "Films the run in the third person into this file, .mp4 or .avi, or a folder of PNGs "
                  "(docs/viewer.md)");
  add_size_option(*run, "--film-size", options->film_size, "Size of the film; default: 1280x720");
  run->add_flag(
      "--viewer", options->viewer,
      "Shows the map while it grows, in a window; closing it does not end the run (docs/viewer.md)");
  add_up_option(
      *run, options->up,
      "Where up is in the world of the run, whose axes are its first camera's: right, down and forward; "
      "auto (by the map's surfaces) or camera (as the cameras were held). What shows or turns the map "
      "later goes by it (docs/viewer.md). Default: auto");
  add_ui_scale_option(*run, options->ui_scale);
  run->add_flag("--overwrite", options->overwrite,
                "Replaces the earlier run that --out holds; other files that are there stay");
  run->add_flag(
      "--strict", options->strict,
      "Ends with exit code 4 where something looks wrong: before the first frame, or when the run has "
      "ended with too few poses, or without one that can be trusted");
  run->add_flag("--quiet", options->quiet, "Prints warnings and errors only");
  run->footer(kRunExamples);
  for (const char* name : {"--format", "--depth-delay", "--assume-camera", "--assume-depth-unit"})
    run->get_option(name)->excludes(live);  // the stream says it itself
  run->callback([options, &action] {
    if (options->dataset.empty() && options->live.empty()) throw CLI::RequiredError("--dataset or --live");
    action = [options] { return run_watched(*options); };
  });
}

}  // namespace surefield
