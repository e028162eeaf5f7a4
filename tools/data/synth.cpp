// surefield synth: writes a sequence with exact ground truth.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <sstream>

#include "engine/synth/sequence_writer.h"
#include "engine/types/error.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

constexpr const char* kSynthExamples =
    "Renders a walk through a furnished scene and writes it as one of the datasets that surefield run reads, "
    "with\n"
    "the true poses. Beside it: mesh.ply, the surfaces of the scene in the same world frame, and synth.json, "
    "these\n"
    "settings. The same settings give the same files on one device. docs/synth.md describes scenes, paths "
    "and "
    "the\n"
    "errors of the Kinect.\n"
    "\n"
    "Examples:\n"
    "  surefield synth --scene office --path handheld --frames 200 --out data/office1\n"
    "  surefield run --dataset data/office1 --scale 0.5 --out out/office1\n"
    "  surefield synth --scene corridor --path loop --frames 2400 --sensor kinect --layout tum --out "
    "data/loop1\n";

const std::map<std::string, SensorKind> kSensors = {{"perfect", SensorKind::Perfect},
                                                    {"kinect", SensorKind::Kinect}};
const std::map<std::string, ExposureCourse> kCourses = {{"drift", ExposureCourse::Drift},
                                                        {"jump", ExposureCourse::Jump},
                                                        {"double", ExposureCourse::Double},
                                                        {"fade-in", ExposureCourse::FadeIn}};
const std::map<std::string, SequenceLayout> kLayouts = {{"replica", SequenceLayout::Replica},
                                                        {"tum", SequenceLayout::Tum}};

struct SynthOptions {
  SynthSettings settings{.width = 640, .height = 480, .frames = 300};
  SequenceLayout layout = SequenceLayout::Replica;
  int beside = 0;
  std::string size = "640x480";
  std::string out;
  std::string device;
  bool quiet = false;
};

void parse_size(const std::string& text, SynthSettings& settings) {
  char cross = 0;
  std::istringstream in(text);
  if (!(in >> settings.width >> cross >> settings.height) || cross != 'x' || !in.eof())
    throw InputError(fmt::format("--size {}: must be WIDTHxHEIGHT in pixels, as in 640x480", text));
}

/// Tells the progress in counts of `what`, unless null.
void write_sequence(const std::filesystem::path& folder, SequenceLayout layout,
                    const SyntheticRecording& recording, const char* what) {
  SequenceWriter writer(folder, layout, recording);
  {
    std::optional<CountProgress> progress;
    if (what) progress.emplace(what, recording.count());
    try {
      for (int i = 0; i < recording.count() && !interrupted(); ++i) {
        writer.write(i);
        if (progress) progress->reached(i + 1);
      }
    } catch (...) {
      writer.finish();
      throw;
    }
  }
  writer.finish();
}

int synthesise(SynthOptions& options) {
  catch_interrupts();
  parse_size(options.size, options.settings);
  gpu::DeviceOptions device;
  device.selector = options.device;
  const SyntheticRecording recording(device, options.settings);
  write_sequence(options.out, options.layout, recording, options.quiet ? nullptr : "frames");
  if (options.beside > 0 && !interrupted()) {
    SynthSettings beside = options.settings;
    beside.beside = options.beside;
    write_sequence(std::filesystem::path(options.out) / "beside", SequenceLayout::Replica,
                   SyntheticRecording(device, beside), options.quiet ? nullptr : "views beside the path");
  }
  return interrupted() ? kInterrupted : kSuccess;
}

void add_kinect_options(CLI::App& synth, SynthSettings& settings) {
  KinectModel& kinect = settings.kinect;
  const std::string group = "With --sensor kinect";
  synth.add_option("--range", kinect.furthest, "Farthest depth, metres")
      ->check(CLI::Range(1.0, 13.0))
      ->capture_default_str()
      ->group(group);
  synth.add_option("--colour-delay", kinect.colour_delay, "Seconds by which colour is later than depth")
      ->check(CLI::Range(-0.05, 0.05))
      ->capture_default_str()
      ->group(group);
  synth
      .add_option("--depth-readout", kinect.depth_readout_seconds,
                  "Seconds from the first row of a depth image to the last")
      ->check(CLI::Range(0.0, 0.05))
      ->capture_default_str()
      ->group(group);
  synth
      .add_option(
          "--exposure", kinect.course,
          "Beside its slow drift: a jump to 0.35 of the light, or to twice of it, or a fade-in over twelve "
          "frames")
      ->transform(CLI::CheckedTransformer(kCourses))
      ->option_text("drift|jump|double|fade-in [drift]")
      ->group(group);
  synth
      .add_option("--exposure-from", settings.exposure_from,
                  "Frame of the jump; default: that in the middle. Choose one in which a place is seen again")
      ->check(CLI::NonNegativeNumber)
      ->group(group);
}

}  // namespace

void add_synth(CLI::App& program, Action& action) {
  auto options = std::make_shared<SynthOptions>();
  CLI::App* synth = program.add_subcommand("synth", "Writes a synthetic sequence with exact ground truth");
  SynthSettings& settings = options->settings;
  synth->add_option("--scene", settings.scene, fmt::format("One of {}", fmt::join(scene_names(), ", ")))
      ->capture_default_str();
  synth
      ->add_option("--path", settings.path,
                   fmt::format("How the camera moves: {}", fmt::join(path_names(), ", ")))
      ->capture_default_str();
  synth->add_option("--frames", settings.frames, "Number of frames, at 30 a second")->capture_default_str();
  synth->add_option("--seed", settings.seed, "Varies furniture, colours, path and noise")
      ->capture_default_str();
  synth->add_option("--sensor", settings.sensor, "A perfect camera, or one with the errors of a Kinect")
      ->transform(CLI::CheckedTransformer(kSensors))
      ->option_text("perfect|kinect [perfect]");
  add_kinect_options(*synth, settings);
  synth->add_option("--layout", options->layout, "Layout of the dataset")
      ->transform(CLI::CheckedTransformer(kLayouts))
      ->option_text("replica|tum [replica]");
  synth
      ->add_option(
          "--beside", options->beside,
          "Also writes so many views 10 cm and 4 degrees beside the path, without errors, to OUT/beside, for "
          "surefield eval --views")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  synth->add_flag("--moving-object", settings.moving_object, "Somebody walks through the scene");
  synth->add_flag("--moved-chair", settings.moved_chair,
                  "A chair stands elsewhere when the camera sees it again");
  synth->add_option("--size", options->size, "Size of the images, pixels")
      ->type_name("WIDTHxHEIGHT")
      ->capture_default_str();
  synth->add_option("--out", options->out, "Folder of the sequence: new, empty, or of an earlier synth")
      ->required();
  synth->add_option("--device", options->device,
                    "Number or part of the name of the device, see surefield devices; default: the best");
  synth->add_flag("--quiet", options->quiet, "Prints errors only");
  synth->footer(kSynthExamples);
  synth->callback([options, &action] { action = [options] { return synthesise(*options); }; });
}

}  // namespace surefield
