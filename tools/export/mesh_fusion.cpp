#include "tools/export/mesh_fusion.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "engine/eval/pose_track.h"
#include "engine/formats/mesh_file.h"
#include "engine/io/trajectory_file.h"
#include "engine/types/error.h"
#include "tools/export/axes_option.h"
#include "tools/results/run_configuration.h"
#include "tools/results/run_folder.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/load_map.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kStampTolerance = 0.02;  // seconds, as between estimates and truth
constexpr float kLeastOpacity = 0.9f;     // of a rendered pixel whose depth is a surface's

/// A frame to fuse: its index in the dataset, and its camera.
struct FusionView {
  int index = 0;
  Camera camera;
};

/// What the frames are taken from.
struct Input {
  std::optional<RunFolder> run;
  Dataset dataset;
  std::vector<FusionView> views;
  double depth_max = 0;   ///< metres; infinite: no limit
  DepthNoise noise;       ///< of the sensor
  double truncation = 0;  ///< of the distance field, metres
};

/// Images to fuse; `valid` is false where the frame cannot be read.
struct FusionImages {
  bool valid = false;
  std::vector<float> depth;
  std::vector<float> colour;
};

const StampedPose* nearest_pose(const Trajectory& trajectory, double timestamp) {
  const StampedPose* nearest = nullptr;
  for (const StampedPose& pose : trajectory) {
    if (!pose.is_finite() || pose.lost || std::abs(pose.timestamp - timestamp) > kStampTolerance) continue;
    if (nearest && std::abs(nearest->timestamp - timestamp) <= std::abs(pose.timestamp - timestamp)) continue;
    nearest = &pose;
  }
  return nearest;
}

/// All frames of the dataset that the trajectory has a pose for.
std::vector<FusionView> views_along(const Trajectory& trajectory, const Recording& recording,
                                    const Intrinsics& intrinsics) {
  std::vector<FusionView> views;
  for (int i = 0; i < recording.count(); ++i) {
    const StampedPose* pose = nearest_pose(trajectory, recording.timestamp(i));
    if (pose) views.push_back({i, {intrinsics, pose->camera_to_world.inverse()}});
  }
  return views;
}

Trajectory read_poses(const std::string& where, const Dataset& dataset) {
  if (where != "true") return of_tracked_camera(read_trajectory(where), *dataset.recording);
  if (!dataset.ground_truth) throw InputError("--trajectory true: this dataset has no ground truth");
  return of_tracked_camera(*dataset.ground_truth, *dataset.recording);
}

/// The frames of a run that were not lost, at its poses.
std::vector<FusionView> views_of_run(const RunFolder& run, const Recording& recording) {
  std::vector<FusionView> views;
  for (const QualityView& view : views_of(run, recording)) views.push_back({view.index, view.camera});
  return views;
}

/// Moves the views to where the camera was when their depth images were taken.
void look_when_depth_was_taken(std::vector<FusionView>& views, const Trajectory& trajectory,
                               const Recording& recording) {
  const PoseTrack track(trajectory);
  for (FusionView& view : views) {
    const double after = recording.depth_after(view.index);
    if (after == 0) continue;
    const auto pose = track.at(recording.timestamp(view.index) + after);
    if (pose) view.camera.world_to_camera = pose->inverse();
  }
}

SlamSettings settings_for(const Input& input) {
  if (input.run) return settings_of(*input.run);
  SlamSettings settings;
  load_settings(settings, RunOptions(), input.dataset.recording->format());
  return settings;
}

/// Says how far depth is used, and how far off it is.
void set_reach(Input& input, const MeshOptions& options) {
  const SlamSettings settings = settings_for(input);
  input.noise = noise_of(settings.sensor);
  input.depth_max = options.depth_max > 0    ? options.depth_max
                    : settings.depth_max > 0 ? settings.depth_max
                                             : std::numeric_limits<double>::infinity();
  input.truncation = options.fusion.truncation;
}

/// Whether a depth tells where the surface is, within the truncation.
bool is_certain(const Input& input, float z) {
  return z <= input.depth_max && input.noise.sigma(z) <= input.truncation;
}

/// The axes that the file will have.
MeshAxes axes_of(const MeshOptions& options) {
  const bool world = !options.trajectory.empty() && options.up.way == UpChoice::Way::Recorded;
  return options.axes.value_or(world ? MeshAxes::World : usual_axes(options.out));
}

/// Refuses to turn what nobody knows how.
void check_axes(const MeshOptions& options) {
  const MeshAxes axes = axes_of(options);
  if (axes == MeshAxes::ZUp && std::filesystem::path(options.out).extension() == ".glb")
    throw InputError(
        "--axes z-up: glTF has y upwards; leave --axes out, or name the mesh .ply, .obj or .stl");
  if (axes == MeshAxes::World && options.up.way != UpChoice::Way::Recorded)
    throw InputError(
        "--up turns the mesh upright, and --axes world leaves it as it is; leave one of them out");
  const bool known = options.up.way == UpChoice::Way::Given || options.up.way == UpChoice::Way::Cameras;
  if (axes != MeshAxes::World && !options.trajectory.empty() && !known)
    throw InputError(
        "where up is in the frame of --trajectory, the run's map does not tell; give --up, as X,Y,Z or "
        "camera");
}

void check(const MeshOptions& options) {
  require_mesh_ending(options.out);
  if (options.run.empty() && options.source == MeshSource::Rendered) {
    throw InputError("rendered depth needs the map of a run: give --run, or --source sensor");
  }
  if (options.source == MeshSource::Rendered && options.trajectory == "true") {
    throw InputError(
        "a run's map has a world frame of its own, in which the true poses look elsewhere; "
        "leave --trajectory out, or give --source sensor");
  }
  if (options.run.empty() && (options.dataset.empty() || options.trajectory.empty())) {
    throw InputError("without --run, fusing needs --dataset and --trajectory");
  }
  check_axes(options);
}

Input open_input(const MeshOptions& options) {
  check(options);
  Input input;
  if (!options.run.empty()) {
    input.run = read_run(options.run);
    input.dataset = open_dataset_of(*input.run, options.dataset);
  } else {
    input.dataset = open_dataset(options.dataset, {.format = options.format});
  }
  set_reach(input, options);
  const Recording& recording = *input.dataset.recording;
  const bool rendered = options.source == MeshSource::Rendered;
  const double scale = rendered ? input.run->number("/dataset/scale") : 1;
  const Intrinsics intrinsics = recording.intrinsics().scaled(scale);
  const Trajectory trajectory = options.trajectory.empty()
                                    ? of_tracked_camera(input.run->trajectory, recording)
                                    : read_poses(options.trajectory, input.dataset);
  std::vector<FusionView> views = options.trajectory.empty() ? views_of_run(*input.run, recording)
                                                             : views_along(trajectory, recording, intrinsics);
  if (!rendered) look_when_depth_was_taken(views, trajectory, recording);
  for (std::size_t i = 0; i < views.size(); i += static_cast<std::size_t>(options.stride)) {
    input.views.push_back({views[i].index, {intrinsics, views[i].camera.world_to_camera}});
  }
  if (input.views.empty()) throw InputError("no frame has a pose; do the time stamps match?");
  return input;
}

/// Depth and colour of the map. Depth is the median one: where surfaces lie behind each other, the mean falls
/// between them.
FusionImages rendered_images(const SplatEngine& engine, const FusionView& view, const Input& input) {
  RenderImages images = engine.render(view.camera);
  for (std::size_t i = 0; i < images.depth_median.size(); ++i) {
    float& z = images.depth_median[i];
    if (images.opacity[i] < kLeastOpacity || !is_certain(input, z)) z = 0;
  }
  return {true, std::move(images.depth_median), std::move(images.colour)};
}

FusionImages sensor_images(const Input& input, const FusionView& view) {
  const LoadedFrame loaded = input.dataset.recording->load(view.index);
  if (!loaded.frame) {
    fmt::print(stderr, "skipped: frame {}: {}\n", view.index, loaded.problem);
    return {};
  }
  FusionImages images{true, {}, {}};
  for (int v = 0; v < loaded.frame->depth.rows; ++v) {
    const float* depth = loaded.frame->depth.ptr<float>(v);
    const uint8_t* colour = loaded.frame->colour.ptr<uint8_t>(v);
    for (int u = 0; u < loaded.frame->depth.cols; ++u) {
      images.depth.push_back(is_certain(input, depth[u]) ? depth[u] : 0);
    }
    for (int i = 0; i < 3 * loaded.frame->colour.cols; ++i) {
      images.colour.push_back(static_cast<float>(colour[i]) / 255);
    }
  }
  return images;
}

/// Fuses view after view until the last one or an interruption; returns how many.
int integrate(TsdfVolume& volume, const Input& input,
              const std::function<FusionImages(const FusionView&)>& take) {
  CountProgress progress("frames fused", static_cast<int>(input.views.size()));
  int fused = 0;
  int done = 0;
  for (const FusionView& view : input.views) {
    if (interrupted()) break;
    const FusionImages images = take(view);
    if (images.valid) {
      volume.integrate({view.camera, images.depth, images.colour, input.noise});
      ++fused;
    }
    progress.reached(++done);
  }
  return fused;
}

/// Where up is in the frame of the poses.
Eigen::Vector3d up_of_poses(const Input& input, const MeshOptions& options) {
  Trajectory poses;
  for (const FusionView& view : input.views)
    poses.push_back({input.dataset.recording->timestamp(view.index), view.camera.world_to_camera.inverse()});
  const auto recorded = input.run ? input.run->up() : std::nullopt;
  const bool by_map = options.up.needs_map(recorded);
  return options.up.of(by_map ? load_map(input.run->map_file()) : GaussianCloud{}, poses, recorded).up;
}

int integrate_source(TsdfVolume& volume, const Input& input, const MeshOptions& options) {
  if (options.source == MeshSource::Sensor) {
    return integrate(volume, input, [&](const FusionView& view) { return sensor_images(input, view); });
  }
  SplatEngine engine(options.engine);
  assign_map(engine, *input.run);
  return integrate(volume, input,
                   [&](const FusionView& view) { return rendered_images(engine, view, input); });
}

}  // namespace

int fuse_mesh(const MeshOptions& options) {
  catch_interrupts();
  const Input input = open_input(options);
  TsdfVolume volume(options.fusion);
  const Clock::time_point start = Clock::now();
  const int fused = integrate_source(volume, input, options);
  TriangleMesh mesh = volume.extract();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (mesh.triangles.empty()) {
    if (interrupted()) return kInterrupted;
    throw InputError(
        fmt::format("no surface was found: no frame has depth{} that is certain to within the truncation, "
                    "{:g} m; is the depth "
                    "scale of the dataset right, and which sensor it is (key sensor)?",
                    std::isfinite(input.depth_max) ? fmt::format(" within {} m", input.depth_max) : "",
                    input.truncation));
  }
  const MeshAxes axes = axes_of(options);
  if (axes != MeshAxes::World) mesh.up = up_of_poses(input, options);
  write_mesh_file(options.out, mesh, axes);
  fmt::print("frames fused     {} of {}, {:.1f} s\n", fused, input.views.size(), seconds);
  fmt::print("distance field   {} blocks, {:.1f} MB\n", volume.blocks(),
             static_cast<double>(volume.bytes()) / 1e6);
  fmt::print("axes             {}\n", name_of(axes));
  fmt::print("mesh             {} vertices, {} triangles: {}\n", mesh.vertices.size(), mesh.triangles.size(),
             options.out);
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace surefield
