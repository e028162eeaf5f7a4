// surefield places: how well keyframes that see the same are found.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

#include "engine/eval/place_metrics.h"
#include "engine/eval/warp_check.h"
#include "engine/slam/covisibility.h"
#include "engine/sources/frame_stream.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

constexpr const char* kPlacesExamples =
    "Takes every so many frames of a sequence with true poses as keyframes and looks up, for each, the k "
    "earlier\n"
    "ones that see the same. They truly do when each sees at least --shared of what the other sees, by true "
    "poses\n"
    "and depth, so that what is hidden does not count. Found: of the k keyframes looked up (of fewer, where "
    "there\n"
    "are fewer to find), those that truly see the same. Recall: of all that truly do, those looked up. For\n"
    "comparison: the most recent keyframes, and the overlap of reprojected depth as SLAM computes it, but at "
    "the\n"
    "true poses. --gap N looks only among keyframes at least N before: 2 leaves out the one just before, and "
    "a\n"
    "large one asks for returns alone. See docs/places.md.\n"
    "\n"
    "Examples:\n"
    "  surefield places --dataset redkitchen\n"
    "  surefield places --dataset corridor --every 15 --gap 60\n"
    "  surefield places --dataset redkitchen --vocabulary own.txt --netvlad netvlad.onnx\n";

constexpr double kDepthWidth = 160;  // pixels; more tell no more about what is seen
constexpr int kCounts[] = {2, 5};    // keyframes that are looked up

struct PlacesOptions {
  std::string dataset;
  int every = 10;
  double scale = 1;
  PlaceSettings settings;
  std::string vocabulary;
  std::string netvlad;
};

/// One way to look keyframes up.
struct Method {
  std::string name;
  /// How well each keyframe so far fits the newest, the last of them, whose images are `frame`.
  std::function<std::vector<double>(const Frame& frame, const std::vector<Keyframe>& keyframes)> rate;
  KeyframeTable scores;
};

/// By the similarity of images.
Method by_images(const std::string& name, const KeyframeSettings& settings) {
  const std::shared_ptr<ImageDescriptor> descriptor = make_descriptor(settings);
  const auto pool = std::make_shared<DescriptorPool>();
  return {name, [=](const Frame& frame, const std::vector<Keyframe>&) {
            pool->add(descriptor->describe(frame.colour));
            return pool->similarities();
          }};
}

std::vector<double> rate_recency(const Frame&, const std::vector<Keyframe>& keyframes) {
  std::vector<double> scores(keyframes.size());
  std::iota(scores.begin(), scores.end(), 1);
  return scores;
}

std::vector<double> rate_overlap(const Frame&, const std::vector<Keyframe>& keyframes) {
  std::vector<double> scores;
  for (const Keyframe& keyframe : keyframes) scores.push_back(overlap(keyframes.back(), keyframe));
  return scores;
}

std::vector<Method> make_methods(const PlacesOptions& options) {
  std::vector<Method> methods;
  methods.push_back(by_images("VLAD over RootSIFT",
                              {.covisibility = CovisibilityKind::Vlad, .vocabulary = options.vocabulary}));
  if (!options.netvlad.empty())
    methods.push_back(
        by_images("network", {.covisibility = CovisibilityKind::NetVlad, .netvlad = options.netvlad}));
  methods.push_back({"most recent", rate_recency});
  methods.push_back({"overlap at the true poses", rate_overlap});
  return methods;
}

/// The keyframes of a sequence, and what each method thinks of them.
struct Places {
  std::vector<PlaceView> views;
  std::vector<Keyframe> keyframes;
  std::vector<Method> methods;
  KeyframeTable shared;

  void add(const Frame& frame, const Camera& camera);
};

void Places::add(const Frame& frame, const Camera& camera) {
  const double scale = std::min(1.0, kDepthWidth / camera.intrinsics.width);
  views.push_back(
      {{camera.intrinsics.scaled(scale), camera.world_to_camera}, resize_frame(frame, scale).depth});
  keyframes.push_back(make_keyframe(frame, 0, camera, sample_points(frame, camera.intrinsics)));
  shared.emplace_back();
  for (const PlaceView& view : views)
    shared.back().push_back(std::min(shared_view(views.back(), view), shared_view(view, views.back())));
  for (Method& method : methods) method.scores.push_back(method.rate(frame, keyframes));
}

/// Reads the sequence; ends early when the user stops it.
void read_keyframes(const PlacesOptions& options, Places& places) {
  const Dataset dataset = open_dataset(options.dataset);
  const Recording& recording = *dataset.recording;
  if (!dataset.ground_truth)
    throw InputError(options.dataset, "has no true poses, without which nobody knows what frames share");
  const PoseTrack track(of_tracked_camera(*dataset.ground_truth, recording));
  FrameStream stream(recording, {.stride = options.every, .scale = options.scale});
  CountProgress progress("keyframes", *stream.size());
  for (int done = 1; !interrupted(); ++done) {
    const auto frame = stream.next();
    if (!frame) break;
    const auto pose = track.at(frame->timestamp);
    if (pose) places.add(*frame, {stream.intrinsics(), pose->inverse()});
    progress.reached(done);
  }
}

std::string percent(double part) {
  return std::isfinite(part) ? fmt::format("{:.1f} %", 100 * part) : "-";
}

std::string table(const Places& places, PlaceSettings settings) {
  const int queries = measure_places(places.shared, places.shared, settings).queries;
  std::string text = fmt::format("{} keyframes, of which {} see what one at least {} before saw\n\n{:<26}",
                                 places.keyframes.size(), queries, settings.gap, "");
  for (int count : kCounts) text += fmt::format("  k = {}: found   recall", count);
  for (const Method& method : places.methods) {
    text += fmt::format("\n{:<26}", method.name);
    for (int count : kCounts) {
      settings.count = count;
      const PlaceMetrics metrics = measure_places(method.scores, places.shared, settings);
      text += fmt::format("  {:>12}  {:>7}", percent(metrics.found), percent(metrics.recall));
    }
  }
  return text + "\n";
}

int measure(const PlacesOptions& options) {
  catch_interrupts();
  Places places;
  places.methods = make_methods(options);
  read_keyframes(options, places);
  fmt::print("{}", table(places, options.settings));
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace

void add_places(CLI::App& program, Action& action) {
  auto options = std::make_shared<PlacesOptions>();
  CLI::App* command =
      program.add_subcommand("places", "Measures how well keyframes that see the same are found");
  command->add_option("--dataset", options->dataset, "Folder of a sequence with true poses")->required();
  command->add_option("--every", options->every, "Every so many frames is a keyframe")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--scale", options->scale, "Size of the images relative to the originals, up to 1")
      ->capture_default_str();
  command->add_option("--gap", options->settings.gap, "Looks among keyframes at least so many before")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--shared", options->settings.shared,
                   "Part of each other's view that two keyframes which see the same must see")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command->add_option("--vocabulary", options->vocabulary,
                      "File of surefield vocabulary; default: the built-in one");
  command->add_option("--netvlad", options->netvlad, "Also measures this network, ONNX (docs/places.md)");
  command->footer(kPlacesExamples);
  command->callback([options, &action] { action = [options] { return measure(*options); }; });
}

}  // namespace surefield
