#include "tools/view/render_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/io/camera_json.h"
#include "engine/io/images.h"
#include "engine/types/error.h"
#include "engine/viewer/cutaway.h"
#include "engine/viewer/film_picture.h"
#include "engine/viewer/film_writer.h"
#include "engine/viewer/follower.h"
#include "engine/viewer/view_path.h"
#include "tools/results/run_scene.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/load_map.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

constexpr const char *kOrbit = "orbit", *kFollow = "follow", *kTrajectory = "trajectory", *kTruth = "truth";
constexpr const char *kKeyframes = "keyframes", *kCamera = "camera", *kSensor = "sensor";
constexpr const char* kLoops = "loops";
constexpr Intrinsics kWideLens{.width = 960, .height = 540, .fx = 780, .fy = 780, .cx = 479.5, .cy = 269.5};

/// One picture: from where, and of which moment of the run.
struct Station {
  Pose camera_to_world = Pose::Identity();
  int frame = -1;  ///< position in the trajectory; -1: none
};

/// A path with all that is needed to go it.
struct Journey {
  std::optional<RunScene> run;
  GaussianCloud map;
  Intrinsics lens;
  std::vector<Station> stations;
  std::optional<Cutaway> cutaway;  ///< what is shown of the map on an orbit, about `middle`
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

bool shows_thing(const RenderOptions& options, const char* thing) {
  return std::find(options.shown.begin(), options.shown.end(), thing) != options.shown.end();
}

bool is_named(const std::string& path) {
  const auto names = view_paths();
  return std::find(names.begin(), names.end(), path) != names.end();
}

/// Refuses what cannot go together, before anything is read.
void check_journey(const RenderOptions& options) {
  const bool with_run = options.path == kFollow || options.path == kTrajectory || options.path == kTruth;
  if (with_run && options.run.empty())
    throw InputError(
        fmt::format("--path {} goes with a camera that was tracked; name its run with --run", options.path));
  if (!options.shown.empty() && options.run.empty())
    throw InputError(
        fmt::format("--show {} shows what a run has found; name it with --run", options.shown.front()));
  for (const char* thing : {kCamera, kSensor})
    if (shows_thing(options, thing) && !with_run)
      throw InputError(fmt::format(
          "--show {0} needs a path that goes with the run: --path follow, trajectory or truth", thing));
  if (!options.sensor_colour.empty() || !options.sensor_depth.empty())
    throw InputError(
        "--sensor-colour and --sensor-depth are of one picture; along a path, --run brings them");
  if (options.path != kOrbit && options.up.way != UpChoice::Way::Recorded)
    throw InputError("--up is where up is for --path orbit; other paths have it from their cameras or keys");
  if (!is_named(options.path) && !std::filesystem::exists(options.path))
    throw InputError(fmt::format("--path {}: is none of {}, and no such file", options.path,
                                 fmt::join(view_paths(), ", ")));
}

void need_dataset(const RunScene& run, const std::string& what) {
  if (!run.dataset)
    throw InputError(
        fmt::format("{} needs the dataset of the run: {}; name it with --dataset", what, run.missing));
}

/// One station for every picture that its time has room for.
std::vector<Station> at_rate(const ViewPath& path, double rate) {
  std::vector<Station> stations;
  const auto count = static_cast<int>(std::floor((path.end() - path.begin()) * rate + 1e-6));
  for (int i = 0; i <= count; ++i) stations.push_back({path.camera_to_world(path.begin() + i / rate)});
  return stations;
}

/// One station for every frame of the run.
std::vector<Station> stations_of_run(const RunScene& run, const std::string& path) {
  const Trajectory& tracked = run.scene.trajectory;
  std::optional<ViewPath> truth;
  if (path == kTruth) {
    need_dataset(run, "--path truth");
    if (run.scene.truth.empty())
      throw InputError(run.run.path, "its dataset has no true trajectory to compare; take --path trajectory");
    truth.emplace(run.scene.truth);
  }
  Follower follower;
  std::vector<Station> stations;
  for (int i = 0; i < static_cast<int>(tracked.size()); ++i) {
    const StampedPose& pose = tracked[i];
    if (!pose.is_finite()) continue;
    if (truth)
      stations.push_back({truth->camera_to_world(pose.timestamp), i});
    else if (path == kFollow)
      stations.push_back({follower.follow(pose.camera_to_world), i});
    else
      stations.push_back({pose.camera_to_world, i});
  }
  return stations;
}

/// The lens for the path, before --size; `own` is that of the path, if it has one.
Intrinsics lens_of(const RenderOptions& options, const std::optional<RunScene>& run,
                   const std::optional<Intrinsics>& own) {
  if (!options.camera.empty()) return read_camera(options.camera).intrinsics;
  if (own) return *own;
  if (options.path != kTrajectory && options.path != kTruth) return kWideLens;
  need_dataset(*run, fmt::format("--path {} without --camera", options.path));
  return run->scene.frame.camera.intrinsics;
}

/// Around the map, with what would hide its inside cut away.
void plan_orbit(const RenderOptions& options, Journey& journey) {
  const Trajectory cameras = journey.run ? journey.run->scene.trajectory : Trajectory{};
  const auto recorded = journey.run ? journey.run->run.up() : std::nullopt;
  const Eigen::Vector3d up = options.up.of(journey.map, cameras, recorded).up;
  journey.stations = at_rate(orbit(journey.map, journey.lens, up, options.seconds), options.rate);
  journey.middle = middle_of(journey.map, up);
  journey.cutaway.emplace(journey.map, cameras);
}

Journey plan(const RenderOptions& options) {
  Journey journey;
  std::optional<RecordedViewPath> recorded;
  if (!is_named(options.path)) recorded = read_view_path(options.path);
  if (!options.run.empty()) journey.run = read_run_scene(options.run, options.dataset);
  journey.lens = lens_of(options, journey.run, recorded ? std::optional(recorded->intrinsics) : std::nullopt);
  if (options.size.width > 0) journey.lens = fit_to(journey.lens, options.size.width, options.size.height);
  if (journey.run && shows_thing(options, kSensor)) need_dataset(*journey.run, "--show sensor");
  journey.map =
      load_map(options.map.empty() ? journey.run->run.map_file() : std::filesystem::path(options.map));
  if (recorded) {
    journey.stations = at_rate(recorded->path, options.rate);
  } else if (options.path == kOrbit) {
    plan_orbit(options, journey);
    if (journey.stations.size() > 1) journey.stations.pop_back();  // the last is the first again
  } else {
    journey.stations = stations_of_run(*journey.run, options.path);
  }
  if (journey.stations.empty()) throw InputError(options.run, "has no frames");
  return journey;
}

/// Where the film of a mode goes; where there are several, its name is in it.
std::filesystem::path film_of(const std::filesystem::path& out, ViewMode mode, bool several) {
  if (!several) return out;
  const std::string name = info_of(mode).name;
  if (out.extension().empty()) return out / name;
  return out.parent_path() / fmt::format("{}_{}{}", out.stem().string(), name, out.extension().string());
}

/// Paints the stations of a journey, one after the other.
class Filming {
 public:
  Filming(const RenderOptions& options, const Journey& journey)
      : options_(options),
        journey_(journey),
        device_({.selector = options.engine.device, .validate = options.engine.validate}),
        painter_(device_) {
    modes_ = chosen_modes(options, [&](ViewMode mode) { return missing_for(mode); });
    if (modes_.empty()) modes_ = {ViewMode::Colour};
    for (ViewMode mode : modes_)
      films_.push_back(
          std::make_unique<FilmWriter>(film_of(options.out, mode, modes_.size() > 1), options.rate));
    if (journey.run) depth_model_ = settings_of(journey.run->run).depth_model;
    painter_.assign(journey.map, depth_model_);
  }

  /// Until the last picture, or until the user interrupts.
  void film_all() {
    const int count = static_cast<int>(journey_.stations.size());
    CountProgress progress("pictures", count);
    for (int i = 0; i < count && !interrupted(); ++i) {
      film(journey_.stations[i]);
      progress.reached(i + 1);
    }
  }

  /// Completes the films and says where they are.
  void close() {
    for (const auto& film : films_) {
      film->close();
      if (!film->notice().empty()) fmt::print(stderr, "surefield: warning: {}\n", film->notice());
      fmt::print("{}: {} pictures of {} x {}\n", film->output().string(), film->pictures(),
                 journey_.lens.width, journey_.lens.height);
    }
  }

 private:
  const char* missing_for(ViewMode mode) const {
    if (!info_of(mode).needs_sensor) return nullptr;
    if (options_.path != kTrajectory) return "--path trajectory, where the camera has images,";
    return journey_.run->dataset ? nullptr : "--dataset, since the run's is not where it was,";
  }

  void film(const Station& station) {
    std::optional<SceneFrame> frame;
    if (needs_frames()) {
      frame = journey_.run->load_frame(station.frame);
      if (!frame) return;  // the run has skipped it as well, or its images have gone since
      painter_.set_sensor(view_of(*frame), frame->camera.intrinsics);
    }
    if (journey_.cutaway)
      painter_.assign(journey_.cutaway->seen_from(station.camera_to_world, journey_.middle), depth_model_);
    const std::vector<Line> lines = lines_at(station);
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      ViewSettings view = options_.view;
      view.mode = modes_[k];
      painter_.paint({journey_.lens, station.camera_to_world.inverse()}, view, lines);
      cv::Mat picture = painter_.picture();
      if (shows_thing(options_, kSensor)) add_inset(picture, frame->colour, Corner::BottomLeft, "camera");
      films_[k]->add(picture);
    }
  }

  bool needs_frames() const {
    return shows_thing(options_, kSensor) || std::any_of(modes_.begin(), modes_.end(), [](ViewMode mode) {
             return info_of(mode).needs_sensor;
           });
  }

  FrameView view_of(const SceneFrame& frame) const {
    return {.width = frame.colour.cols,
            .height = frame.colour.rows,
            .colour = frame.colour.data,
            .depth = frame.depth.ptr<float>()};
  }

  std::vector<Line> lines_at(const Station& station) const {
    if (!journey_.run) return {};
    ViewerScene scene = journey_.run->scene;
    if (station.frame >= 0) {
      scene.frame.index = station.frame;
      scene.frame.camera.world_to_camera = scene.trajectory[station.frame].camera_to_world.inverse();
    }
    return lines_of(scene, {.trajectory = shows_thing(options_, kTrajectory),
                            .truth = shows_thing(options_, kTruth),
                            .keyframes = shows_thing(options_, kKeyframes),
                            .window = false,
                            .loops = shows_thing(options_, kLoops),
                            .camera = shows_thing(options_, kCamera)});
  }

  const RenderOptions& options_;
  const Journey& journey_;
  gpu::Device device_;
  ViewPainter painter_;
  DepthModel depth_model_ = DepthModel::Plane;
  std::vector<ViewMode> modes_;
  std::vector<std::unique_ptr<FilmWriter>> films_;  ///< one for each mode
};

}  // namespace

std::vector<std::string> view_paths() {
  return {kOrbit, kFollow, kTrajectory, kTruth};
}

std::vector<std::string> shown_things() {
  return {kTrajectory, kTruth, kKeyframes, kLoops, kCamera, kSensor};
}

int render_path(const RenderOptions& options) {
  check_journey(options);
  catch_interrupts();
  const Journey journey = plan(options);
  Filming filming(options, journey);
  filming.film_all();
  filming.close();
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace surefield
