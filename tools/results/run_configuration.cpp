#include "tools/results/run_configuration.h"

#include <filesystem>

#include "engine/config/built_in_configs.h"
#include "engine/synth/synthetic_recording.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kSynthetic = "synthetic";

}  // namespace

Dataset open_run_dataset(const RunOptions& options) {
  if (options.dataset != kSynthetic)
    return open_dataset(options.dataset, {.format = options.format,
                                          .depth_delay = options.depth_delay.value_or(0),
                                          .camera = options.assumed_camera,
                                          .depth_unit = options.assumed_depth_unit,
                                          .colour_topic = options.colour_topic,
                                          .depth_topic = options.depth_topic});
  if (options.format != "auto" && options.format != kSynthetic) {
    throw InputError("--dataset synthetic has no files of the format " + options.format +
                     "; leave --format out (a folder of that name is given as ./synthetic)");
  }
  gpu::DeviceOptions device;
  device.selector = options.engine.device;
  device.validate = options.engine.validate;
  auto recording = std::make_unique<SyntheticRecording>(device);
  Trajectory truth = recording->ground_truth();
  return {std::move(recording), std::move(truth)};
}

RunOptions with_depth_delay(RunOptions options) {
  if (options.depth_delay || options.dataset == kSynthetic || !options.live.empty()) return options;
  const Dataset dataset = open_run_dataset(options);
  if (!has_depth_stamps(*dataset.recording)) return options;
  options.estimated_depth_delay = estimate_depth_delay(*dataset.recording);
  options.depth_delay = options.estimated_depth_delay->usable();
  return options;
}

std::string dataset_path(const RunOptions& options) {
  if (options.dataset == kSynthetic || !options.live.empty()) return options.dataset;
  const auto path = std::filesystem::weakly_canonical(options.dataset);
  return (path.has_filename() ? path : path.parent_path()).string();
}

std::string load_settings(SlamSettings& settings, const RunOptions& options, const std::string& format) {
  ConfigSchema schema;
  settings.bind(schema);
  const BuiltInFiles& built_in = built_in_configs();
  if (!options.config.empty()) {
    schema.load_file(options.config, built_in);
  } else {
    const std::string own = format + ".yaml";
    schema.load_built_in(built_in.contains(own) ? own : "base.yaml", built_in);
  }
  for (const std::string& assignment : options.assignments) schema.set(assignment);
  if (options.budget_ms) schema.set("budget_ms=" + std::to_string(*options.budget_ms));
  return schema.dump();
}

}  // namespace surefield
