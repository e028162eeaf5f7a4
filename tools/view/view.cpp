// surefield view: a window on a map, or on all that a run has left.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "engine/types/error.h"
#include "engine/window/viewer.h"
#include "tools/results/run_scene.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/load_map.h"
#include "tools/shared/up_option.h"

namespace surefield {

namespace {

constexpr const char* kViewExamples =
    "Shows a map in a window: walk through it, see depth, uncertainty, ellipsoids or normals instead of\n"
    "colours, and, for the folder of a run, play the trajectory back beside the camera's images. The keys\n"
    "are listed in the window; docs/viewer.md explains the modes. Without a display, use surefield render.\n"
    "\n"
    "Examples:\n"
    "  surefield view out/desk\n"
    "  surefield view out/desk/map.ply\n";

struct ViewOptions {
  std::string what;  ///< a folder of a run, or a file
  std::string dataset;
  std::string out = ".";
  EngineOptions engine;
  UpChoice up;
};

std::vector<FrameNumbers> numbers_of(const RunFolder& run) {
  std::vector<FrameNumbers> numbers;
  for (const nlohmann::json& frame : run.metrics["per_frame"])
    numbers.push_back(
        {.loss = frame.value("loss", NAN),
         .frames_per_second = 1000 / (frame.value("tracking_ms", NAN) + frame.value("mapping_ms", NAN)),
         .gaussians = frame.value("gaussians", NAN),
         .ate_cm = NAN});
  return numbers;
}

void add_run_to(ViewerInput& input, const std::shared_ptr<const RunScene>& of) {
  const SlamSettings settings = settings_of(of->run);
  input.depth_model = settings.depth_model;
  if (settings.depth_max > 0) input.depth_far = settings.depth_max;
  input.scene = of->scene;
  input.scene.numbers = numbers_of(of->run);
  input.scene.status = fmt::format("{}: {} frames, {} keyframes", of->run.name, of->scene.trajectory.size(),
                                   of->scene.keyframes.size());
  if (of->dataset)
    input.load_frame = [of](int position) { return of->load_frame(position); };
  else
    fmt::print(stderr, "surefield: warning: no camera images and no true trajectory: {}\n", of->missing);
}

int view(const ViewOptions& options) {
  if (const std::string problem = viewer_problem(); !problem.empty())
    throw InputError("surefield view: " + problem + "; without a window, use surefield render");
  catch_interrupts();
  ViewerInput input;
  input.title = "Surefield: " + options.what;
  input.out = options.out;
  input.engine = options.engine;
  input.interrupted = interrupted;
  std::filesystem::path file = options.what;
  std::optional<UpDirection> recorded;
  if (std::filesystem::is_directory(file)) {
    const auto run = std::make_shared<const RunScene>(read_run_scene(file, options.dataset));
    file = run->run.map_file();
    add_run_to(input, run);
    recorded = run->run.up();
  } else {
    input.scene.status = options.what;
  }
  input.map = load_map(file);
  input.up = options.up.of(input.map, input.scene.trajectory, recorded).up;
  for (const std::string& message : show_viewer(std::move(input)))
    fmt::print(stderr, "surefield: validation: {}\n", message);
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace

void add_view(CLI::App& program, Action& action) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = program.add_subcommand("view", "Shows a map, or a run's results, in a window");
  command
      ->add_option("run_or_map", options->what, "Folder that surefield run has written, or a map (PLY, SPZ)")
      ->required();
  command->add_option("--dataset", options->dataset, "Where the run's dataset is now");
  command->add_option("--out", options->out, "Folder of screenshots and saved maps")->capture_default_str();
  add_up_option(
      *command, options->up,
      "Where up is, in the world of the map; auto (by its surfaces) or camera (as the cameras were held). "
      "Default: as the run has recorded it, else auto");
  command->add_option("--device", options->engine.device,
                      "Number or part of the name of the device, see surefield devices; default: the best");
  command->add_flag("--validate", options->engine.validate, "Runs under Vulkan's validation layer (slow)");
  command->footer(kViewExamples);
  command->callback([options, &action] { action = [options] { return view(*options); }; });
}

}  // namespace surefield
