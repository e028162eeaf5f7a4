// surefield convert: a recording in another layout.
#include <fmt/format.h>

#include <memory>

#include "engine/sources/open_dataset.h"
#include "engine/sources/recording_writer.h"
#include "engine/types/error.h"
#include "tools/results/run_configuration.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"
#include "tools/shared/say.h"

namespace surefield {

namespace {

constexpr const char* kConvertExamples =
    "Writes a recording of any layout that surefield run reads in another one: as TUM's benchmark has it "
    "(tum), the\n"
    "simplest folder of images (plain), or a ROS 2 log (mcap). Images are written undistorted, and depth "
    "registered\n"
    "to colour, as SLAM sees them; colour is stored without loss. What a layout cannot hold as it is, such "
    "as depths\n"
    "between its steps, is refused unless --lossy rounds it. Frames that cannot be read are left out, and "
    "named.\n"
    "\n"
    "Examples:\n"
    "  surefield convert walk.bag --to tum --out walk\n"
    "  surefield convert 7scenes/office/seq-01 --to mcap --out office.mcap\n"
    "  surefield convert scan.sens --to plain --out scan --frames 200\n";

struct ConvertOptions {
  std::string source, to, out;
  std::string format = "auto", colour_topic, depth_topic;
  double depth_unit = 0;  ///< metres; 0: that of the source
  int start = 0, frames = 0;
  bool lossy = false;
};

std::unique_ptr<RecordingWriter> make_writer(const ConvertOptions& options, const Recording& recording) {
  const WrittenRecording written{
      .name = recording.name(),
      .intrinsics = recording.intrinsics(),
      .depth_unit = options.depth_unit > 0 ? options.depth_unit : recording.depth_unit(),
      .lossy = options.lossy};
  if (options.to == "tum") return write_tum(options.out, written);
  if (options.to == "plain") return write_plain(options.out, written);
  return write_mcap(options.out, written);
}

/// Writes the frames that were asked for; returns how many.
int write_frames(const ConvertOptions& options, const Recording& recording, RecordingWriter& writer) {
  const int end =
      options.frames > 0 ? std::min(recording.count(), options.start + options.frames) : recording.count();
  CountProgress progress("frames", std::max(0, end - options.start));
  int written = 0;
  for (int i = options.start; i < end && !interrupted(); ++i) {
    const LoadedFrame loaded = recording.load(i);
    if (loaded.frame) {
      writer.write({*loaded.frame, recording.depth_timestamp(i)});
      ++written;
    } else {
      say(stderr, "surefield: warning: {}; the frame is left out\n", loaded.problem);
    }
    progress.reached(i - options.start + 1);
  }
  return written;
}

int convert(const ConvertOptions& options) {
  catch_interrupts();
  const Dataset dataset = open_dataset(
      options.source,
      {.format = options.format, .colour_topic = options.colour_topic, .depth_topic = options.depth_topic});
  const Recording& recording = *dataset.recording;
  for (const std::string& line : recording.assumptions()) say(stderr, "surefield: assumed: {}\n", line);
  for (const std::string& line : recording.warnings()) say(stderr, "surefield: warning: {}\n", line);
  if (options.start >= recording.count())
    throw InputError(options.source, fmt::format("has {} frames; --start {} is behind them",
                                                 recording.count(), options.start));
  const auto writer = make_writer(options, recording);
  const int written = write_frames(options, recording, *writer);
  std::optional<Trajectory> truth = dataset.ground_truth;
  if (truth) truth = of_tracked_camera(std::move(*truth), recording);
  writer->finish(truth);
  if (written == 0 && !interrupted()) throw InputError(options.source, "has no frame that can be read");
  fmt::print("{}: {} frames, {}{}\n", options.out, written, options.to, truth ? ", with true poses" : "");
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace

void add_convert(CLI::App& program, Action& action) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = program.add_subcommand("convert", "Writes a recording in another layout");
  command
      ->add_option("source", options->source, "Folder of the sequence (or a .sens, .mcap, .db3 or .bag file)")
      ->required();
  command->add_option("--to", options->to, "Layout that is written")
      ->required()
      ->check(CLI::IsMember({"tum", "plain", "mcap"}));
  command->add_option("--out", options->out, "New folder, or .mcap file")->required();
  command->add_option("--format", options->format, "Layout of the source")->capture_default_str();
  command->add_option("--colour-topic", options->colour_topic,
                      "Topic of the colour images in a log, where the one that is found is another");
  command->add_option("--depth-topic", options->depth_topic, "The same of the depth images");
  command
      ->add_option("--depth-unit", options->depth_unit,
                   "Metres for one step of the depth images that are written; default: as the source has it")
      ->check(CLI::PositiveNumber);
  command->add_option("--start", options->start, "First frame")->check(CLI::NonNegativeNumber);
  command->add_option("--frames", options->frames, "At most so many frames; default: all")
      ->check(CLI::PositiveNumber);
  command->add_flag("--lossy", options->lossy, "Rounds what the layout cannot hold, instead of refusing it");
  command->footer(kConvertExamples);
  command->callback([options, &action] { action = [options] { return convert(*options); }; });
}

}  // namespace surefield
