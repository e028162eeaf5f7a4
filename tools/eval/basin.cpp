// surefield basin: the options; the work is in tracking_basin.
#include <memory>

#include "tools/eval/tracking_basin.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr const char* kBasinExamples =
    "How far off may a starting pose be for tracking to find the right one? Takes frames spread over a "
    "finished\n"
    "run, moves the pose that the run found for them by 1, 3 and 10 cm, turns it by 1, 3 and 10 degrees, or\n"
    "both, and tracks them from there, by Gauss-Newton and by Adam, in renders of the run's map, which stays "
    "as it is. A\n"
    "frame has returned where it ends within 1 cm and 1 degree of the pose that the same method finds from "
    "the\n"
    "run's own. The median error is the distance to that pose. All other settings are the run's; --set "
    "changes\n"
    "them. Ctrl-C prints the frames so far. See docs/evaluation.md.\n"
    "\n"
    "Examples:\n"
    "  surefield basin --run out/desk\n"
    "  surefield basin --run out/desk --frames 30 --json basin.json\n"
    "  surefield basin --run out/desk --set adam.iterations=100 --set gauss_newton.renders=4\n";

}  // namespace

void add_basin(CLI::App& program, Action& action) {
  auto options = std::make_shared<BasinOptions>();
  CLI::App* basin =
      program.add_subcommand("basin", "Measures from how far tracking finds the pose of a run's frames");
  basin->add_option("--run", options->run, "Folder of results of surefield run")->required();
  basin->add_option("--dataset", options->dataset,
                    "Folder of the run's dataset, where it is no longer where it was");
  basin->add_option("--frames", options->frames, "Number of frames, spread over the run, at most")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  basin->add_option("--seed", options->seed, "Varies the directions of motion and the axes of rotation")
      ->capture_default_str();
  basin->add_option("--set", options->assignments, "Sets one key, as in --set gauss_newton.renders=5")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  basin->add_option("--json", options->json, "Also writes what was measured to this file");
  basin->add_option("--device", options->engine.device,
                    "Number or part of the name of the device, see surefield devices; default: the best");
  basin->footer(kBasinExamples);
  basin->callback([options, &action] { action = [options] { return measure_basin(*options); }; });
}

}  // namespace surefield
