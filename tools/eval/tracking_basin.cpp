#include "tools/eval/tracking_basin.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/io/files.h"
#include "engine/sources/frame_stream.h"
#include "engine/synth/random.h"
#include "engine/types/error.h"
#include "engine/types/median.h"
#include "tools/results/run_configuration.h"
#include "tools/results/run_folder.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/load_map.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNearMetres = 0.01;  // of the undisturbed result: the frame has come back
constexpr double kNearRadians = kDegree;

/// How far a starting pose is from the undisturbed one: metres and radians.
struct Disturbance {
  double translation = 0;
  double rotation = 0;
};

constexpr Disturbance kDisturbances[] = {{0.01, 0},       {0.03, 0},           {0.10, 0},
                                         {0, kDegree},    {0, 3 * kDegree},    {0, 10 * kDegree},
                                         {0.01, kDegree}, {0.03, 3 * kDegree}, {0.10, 10 * kDegree}};

struct Method {
  const char* name;  ///< as tracking.method
  TrackingMethod method;
};

constexpr Method kMethods[] = {{"gauss-newton", TrackingMethod::GaussNewton}, {"adam", TrackingMethod::Adam}};

/// What came of the frames that were tracked by one method after one disturbance.
struct BasinRow {
  Method method;
  Disturbance disturbance;
  std::vector<double> translations;  ///< end errors, metres
  std::vector<double> rotations;     ///< end errors, radians
  double milliseconds = 0;           ///< of all

  void add(const Pose& reference, const TrackingResult& result);
  double returned() const;  ///< fraction of the frames
  double milliseconds_each() const { return milliseconds / static_cast<double>(translations.size()); }
};

/// `pose` seen from a camera that has been turned and moved.
Pose disturbed(const Pose& pose, const Disturbance& disturbance, RandomStream& random) {
  const auto direction = [&] {
    const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * std::numbers::pi);
    const double radius = std::sqrt(1 - z * z);
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  Pose motion = Pose::Identity();
  motion.translate(disturbance.translation * direction());
  motion.rotate(Eigen::AngleAxisd(disturbance.rotation, direction()));
  return motion * pose;
}

void BasinRow::add(const Pose& reference, const TrackingResult& result) {
  const Pose motion = result.world_to_camera * reference.inverse();
  // The distance of the camera's places in the world.
  translations.push_back(
      (result.world_to_camera.inverse().translation() - reference.inverse().translation()).norm());
  rotations.push_back(Eigen::AngleAxisd(motion.linear()).angle());
  milliseconds += result.milliseconds;
}

double BasinRow::returned() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < translations.size(); ++i)
    count += translations[i] <= kNearMetres && rotations[i] <= kNearRadians ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(translations.size());
}

std::vector<BasinRow> make_rows() {
  std::vector<BasinRow> rows;
  for (const Method& method : kMethods)
    for (const Disturbance& disturbance : kDisturbances) rows.push_back({method, disturbance, {}, {}, 0});
  return rows;
}

/// Frames that were not lost, evenly spread: in the middle of so many equal parts of the run.
std::vector<QualityView> spread_views(const RunFolder& run, const Recording& recording, int count) {
  std::vector<QualityView> tracked;
  const std::vector<QualityView> all = views_of(run, recording);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool lost = run.metrics["per_frame"][i].value("lost", false);
    if (!lost && all[i].camera.world_to_camera.matrix().allFinite()) tracked.push_back(all[i]);
  }
  if (tracked.empty()) throw InputError(run.path, "has no frame that was not lost");
  const std::size_t parts = std::min(static_cast<std::size_t>(count), tracked.size());
  std::vector<QualityView> views;
  for (std::size_t i = 0; i < parts; ++i)
    views.push_back(tracked[(2 * i + 1) * tracked.size() / (2 * parts)]);
  return views;
}

/// Measures frame after frame.
class Basin {
 public:
  Basin(const BasinOptions& options, const RunFolder& run)
      : run_(run), seed_(options.seed), engine_(options.engine) {
    load_settings(settings_,
                  {.config = (run.path / "config.yaml").string(), .assignments = options.assignments}, "");
    engine_.assign(load_map(run.map_file()), settings_.depth_model);
  }

  /// Tracks a frame from all starting poses. Returns false, with nothing done, where it cannot be read.
  bool measure(const Recording& recording, const QualityView& view) {
    const LoadedFrame loaded = recording.load(view.index);
    if (!loaded.frame) {
      fmt::print(stderr, "skipped: frame {}: {}\n", view.index, loaded.problem);
      return false;
    }
    const Frame frame = resize_frame(*loaded.frame, run_.number("/dataset/scale"));
    const FrameHandle handle =
        engine_.load({frame.colour.cols, frame.colour.rows, frame.colour.ptr<uint8_t>(),
                      frame.depth.ptr<float>(), noise_of(settings_.sensor)});
    for (const Method& method : kMethods) measure(handle, view, method);
    engine_.release(handle);
    return true;
  }

  const std::vector<BasinRow>& rows() const { return rows_; }

 private:
  void measure(FrameHandle handle, const QualityView& view, const Method& method) {
    TrackingSettings tracking = settings_.tracking;
    tracking.method = method.method;
    const Pose reference = engine_.track(handle, view.camera, tracking).world_to_camera;
    // All methods start from the same poses.
    RandomStream random(hash_key(seed_, static_cast<uint32_t>(view.index)));
    for (BasinRow& row : rows_) {
      if (row.method.method != method.method) continue;
      Camera start = view.camera;
      start.world_to_camera = disturbed(start.world_to_camera, row.disturbance, random);
      row.add(reference, engine_.track(handle, start, tracking));
    }
  }

  const RunFolder& run_;
  uint32_t seed_;
  SlamSettings settings_;
  SplatEngine engine_;
  std::vector<BasinRow> rows_ = make_rows();
};

std::string table(const std::vector<BasinRow>& rows) {
  std::string text = fmt::format("{:<14}{:>6}{:>7}{:>11}{:>18}{:>10}\n", "method", "cm", "deg", "returned",
                                 "median error", "ms/frame");
  for (const BasinRow& row : rows) {
    text += fmt::format("{:<14}{:>6.0f}{:>7.0f}{:>9.0f} %{:>9.2f} mm{:>6.2f}°{:>10.1f}\n", row.method.name,
                        100 * row.disturbance.translation, row.disturbance.rotation / kDegree,
                        100 * row.returned(), 1000 * median(row.translations),
                        median(row.rotations) / kDegree, row.milliseconds_each());
  }
  return text;
}

std::string basin_json(const BasinOptions& options, const std::vector<BasinRow>& rows) {
  nlohmann::ordered_json json = {{"schema", "surefield-basin"},
                                 {"version", 1},
                                 {"frames", rows.front().translations.size()},
                                 {"seed", options.seed}};
  for (const BasinRow& row : rows) {
    json["starts"].push_back({{"method", row.method.name},
                              {"translation_m", row.disturbance.translation},
                              {"rotation_rad", row.disturbance.rotation},
                              {"returned", row.returned()},
                              {"median_translation_m", median(row.translations)},
                              {"median_rotation_rad", median(row.rotations)},
                              {"milliseconds", row.milliseconds_each()}});
  }
  return json.dump(2) + "\n";
}

}  // namespace

int measure_basin(const BasinOptions& options) {
  catch_interrupts();
  const RunFolder run = read_run(options.run);
  const Dataset dataset = open_dataset_of(run, options.dataset);
  const std::vector<QualityView> views = spread_views(run, *dataset.recording, options.frames);
  Basin basin(options, run);
  int measured = 0;
  {
    CountProgress progress("frames", static_cast<int>(views.size()));
    for (std::size_t i = 0; i < views.size() && !interrupted(); ++i) {
      measured += basin.measure(*dataset.recording, views[i]) ? 1 : 0;
      progress.reached(static_cast<int>(i) + 1);
    }
  }
  if (measured == 0) {
    if (interrupted()) return kInterrupted;
    throw InputError(run.path, "has no frame whose images can be read; is the dataset complete?");
  }
  if (!options.json.empty()) {
    const std::string json = basin_json(options, basin.rows());
    write_file(options.json, [&](std::ostream& stream) { stream << json; });
  }
  fmt::print("{} frames, each tracked from a pose that is so far away\n\n{}", measured, table(basin.rows()));
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace surefield
