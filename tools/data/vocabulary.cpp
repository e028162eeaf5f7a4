// surefield vocabulary: finds the visual words that keyframes are described by.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "engine/io/files.h"
#include "engine/places/vocabulary.h"
#include "engine/sources/frame_stream.h"
#include "engine/sources/open_dataset.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

constexpr const char* kVocabularyExamples =
    "With keyframes.covisibility=vlad, keyframes that see the same are found by what their images look like: "
    "by\n"
    "their RootSIFT features, each as it differs from the word nearest to it. The program carries a "
    "vocabulary\n"
    "inside it; this command makes another, for scenes of another kind, by clustering the features of\n"
    "recordings (k-means). The same frames give the same words. `surefield places` tells how well a "
    "vocabulary\n"
    "finds places again; docs/places.md has the commands that made the built-in one.\n"
    "\n"
    "Examples:\n"
    "  surefield vocabulary --dataset walk1 --dataset walk2 --words 64 --out forest.txt\n"
    "  surefield run --dataset walk3 --set keyframes.covisibility=vlad --set "
    "keyframes.vocabulary=forest.txt \\\n"
    "    --out out/walk3\n";

struct VocabularyOptions {
  std::vector<std::string> datasets;
  std::string out;
  int every = 10;
  VocabularySettings settings;
};

/// The features of every so many frames; those so far when the user stops it.
LocalFeatures collect_features(const std::string& folder, int every) {
  const Dataset dataset = open_dataset(folder);
  FrameStream stream(*dataset.recording, {.stride = every});
  CountProgress progress("frames of " + stream.name(), *stream.size());
  LocalFeatures features(0, kFeatureSize);
  for (int done = 1; !interrupted(); ++done) {
    const auto frame = stream.next();
    if (!frame) break;
    const LocalFeatures more = root_sift(frame->colour);
    features.conservativeResize(features.rows() + more.rows(), Eigen::NoChange);
    features.bottomRows(more.rows()) = more;
    progress.reached(done);
  }
  return features;
}

int make_vocabulary(const VocabularyOptions& options) {
  catch_interrupts();
  LocalFeatures features(0, kFeatureSize);
  for (const std::string& folder : options.datasets) {
    const LocalFeatures more = collect_features(folder, options.every);
    features.conservativeResize(features.rows() + more.rows(), Eigen::NoChange);
    features.bottomRows(more.rows()) = more;
    if (interrupted()) return kInterrupted;
  }
  Vocabulary vocabulary;
  {
    CountProgress progress("rounds", options.settings.rounds);
    vocabulary = train_vocabulary(features, options.settings, [&](int round) {
      progress.reached(round);
      return !interrupted();
    });
  }
  const std::string heading =
      fmt::format("{} visual words of {} RootSIFT features: a row each, thousandths (docs/places.md)",
                  vocabulary.words.rows(), features.rows());
  write_file(options.out, [&](std::ostream& stream) { stream << vocabulary_text(vocabulary, heading); });
  fmt::print("{}: {} words of {} features\n", options.out, vocabulary.words.rows(), features.rows());
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace

void add_vocabulary(CLI::App& program, Action& action) {
  auto options = std::make_shared<VocabularyOptions>();
  CLI::App* command = program.add_subcommand(
      "vocabulary", "Finds the visual words by which keyframes are described, from recordings");
  command->add_option("--dataset", options->datasets, "Folder of a sequence; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--out", options->out, "The vocabulary, a text file")->required();
  command
      ->add_option("--words", options->settings.words,
                   "Number of words; a descriptor has 128 times as many numbers")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--every", options->every, "Takes every so many frames")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--seed", options->settings.seed, "Of the words that clustering starts from")
      ->capture_default_str();
  command->footer(kVocabularyExamples);
  command->callback([options, &action] { action = [options] { return make_vocabulary(*options); }; });
}

}  // namespace surefield
