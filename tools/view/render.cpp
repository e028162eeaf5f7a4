// surefield render: images of a map seen from one camera.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "engine/io/camera_json.h"
#include "engine/io/images.h"
#include "engine/report/colour_maps.h"
#include "engine/splat/engine.h"
#include "engine/types/error.h"
#include "engine/viewer/view_painter.h"
#include "tools/results/run_folder.h"
#include "tools/shared/command.h"
#include "tools/shared/load_map.h"
#include "tools/view/render_path.h"

namespace surefield {

namespace {

constexpr const char* kRenderExamples =
    "Of one camera, writes colour.png and, as uncompressed 32-bit float TIFF: colour, opacity, depth\n"
    "(blended), depth_normalised (divided by the opacity), depth_median (0 where there is none), "
    "uncertainty\n"
    "(0 without sensor depth), dominator (index of the Gaussian of the largest weight, -1 where there is\n"
    "none; exact up to 16777216), dominator_weight and gaussian_uncertainty (what the map knows of its\n"
    "Gaussians' errors of depth: the mean of those seen, in square metres). Depths are in metres.\n"
    "gaussian_uncertainty.png shows the root of that from 0 (black) over 10 cm (red) to 20 cm (pale "
    "yellow);\n"
    "grey is where there is nothing. With --mode, writes pictures for people instead, one PNG named after\n"
    "each mode (docs/viewer.md).\n"
    "The camera is JSON: width, height, fx, fy, cx, cy (pixels, centres at integers) and world_to_camera\n"
    "(four rows of four numbers).\n"
    "\n"
    "With --path, writes a film, or a series of PNGs where --out is a folder; with several modes, one of\n"
    "each. A path of keys is JSON: the camera's intrinsics as above and \"keys\", a list of {\"time\":\n"
    "seconds, \"position\": [x, y, z], \"look_at\": [x, y, z]} or {\"time\": ..., \"world_to_camera\": "
    "...}.\n"
    "\n"
    "Examples:\n"
    "  surefield render --map out/demo/map.ply --camera camera.json --out out/view\n"
    "  surefield render --map map.ply --camera camera.json --out view --sensor-depth depth.png --depth-scale "
    "5000\n"
    "  surefield render --map map.ply --camera camera.json --out view --mode depth --mode ellipsoids\n"
    "  surefield render --map map.ply --camera camera.json --out view --mode error --sensor-colour rgb.png\n"
    "  surefield render --map map.ply --path orbit --out orbit.mp4\n"
    "  surefield render --map map.ply --path orbit --up 0,-0.9,-0.4 --out orbit.mp4\n"
    "  surefield render --run out/desk --path follow --show trajectory --show camera --out follow.mp4\n"
    "  surefield render --run out/desk --path trajectory --mode colour --mode error --out frames\n"
    "  surefield render --map map.ply --path keys.json --size 1280x720 --out flight.avi\n";

constexpr double kPaleYellow = 0.2;  // metres, the end of the scale of gaussian_uncertainty.png

std::vector<float> read_sensor_depth(const RenderOptions& options, const Intrinsics& intrinsics) {
  if (!(options.depth_scale >= 1)) {
    throw InputError(
        fmt::format("--depth-scale {} is no number of steps per metre; TUM RGB-D has 5000, depth in "
                    "millimetres 1000",
                    options.depth_scale));
  }
  const cv::Mat depth = read_depth(options.sensor_depth, {1 / options.depth_scale});
  if (depth.cols != intrinsics.width || depth.rows != intrinsics.height) {
    throw InputError(options.sensor_depth, fmt::format("is {} x {}, but the camera is {} x {}", depth.cols,
                                                       depth.rows, intrinsics.width, intrinsics.height));
  }
  return {depth.begin<float>(), depth.end<float>()};
}

/// The Gaussians with their uncertainty in the place of their colour.
GaussianCloud coloured_by_uncertainty(GaussianCloud cloud) {
  constexpr float kShBase = 0.28209479177387814f;  // the SH basis function of degree 0
  cloud.sh_degree = 0;
  cloud.sh.clear();
  for (float uncertainty : cloud.uncertainty)
    cloud.sh.insert(cloud.sh.end(), 3, (uncertainty - 0.5f) / kShBase);
  return cloud;
}

/// `images` shows a map coloured_by_uncertainty().
void write_gaussian_uncertainty(const std::filesystem::path& folder, const RenderImages& images) {
  cv::Mat uncertainty(images.height, images.width, CV_32FC1), root;
  cv::Mat seen(images.height, images.width, CV_8UC1);
  for (int i = 0; i < images.height * images.width; ++i) {
    const float opacity = images.opacity[i];
    seen.data[i] = opacity > 0;
    uncertainty.ptr<float>()[i] = opacity > 0 ? std::max(0.0f, images.colour[3 * i] / opacity) : 0.0f;
  }
  write_tiff(folder / "gaussian_uncertainty.tiff", uncertainty);
  cv::sqrt(uncertainty, root);
  write_png(folder / "gaussian_uncertainty.png",
            apply_colours(root, seen, {.map = ColourMap::Error, .high = kPaleYellow}));
}

void write_images(const std::filesystem::path& folder, RenderImages& images) {
  const cv::Mat colour(images.height, images.width, CV_32FC3, images.colour.data());
  write_png(folder / "colour.png", colour);
  write_tiff(folder / "colour.tiff", colour);
  const auto write = [&](const char* name, std::vector<float>& values) {
    write_tiff(folder / name, cv::Mat(images.height, images.width, CV_32FC1, values.data()));
  };
  write("opacity.tiff", images.opacity);
  write("depth.tiff", images.depth);
  write("depth_normalised.tiff", images.depth_normalised);
  write("depth_median.tiff", images.depth_median);
  write("uncertainty.tiff", images.uncertainty);
  write("dominator_weight.tiff", images.dominator_weight);
  std::vector<float> dominator(images.dominator.begin(), images.dominator.end());
  write("dominator.tiff", dominator);
}

cv::Mat read_sensor_colour(const std::string& file, const Intrinsics& intrinsics) {
  const cv::Mat colour = read_colour(file);
  if (colour.cols != intrinsics.width || colour.rows != intrinsics.height)
    throw InputError(file, fmt::format("is {} x {}, but the camera is {} x {}", colour.cols, colour.rows,
                                       intrinsics.width, intrinsics.height));
  return colour;
}

/// The option whose file the mode needs; nullptr where there is none missing.
const char* missing_for(ViewMode mode, const RenderOptions& options) {
  if (mode == ViewMode::Uncertainty) return options.sensor_depth.empty() ? "--sensor-depth" : nullptr;
  if (!info_of(mode).needs_sensor) return nullptr;
  return options.sensor_colour.empty() ? "--sensor-colour" : nullptr;
}

/// The map to render, and the depth of its Gaussians over their footprints.
struct ChosenMap {
  GaussianCloud cloud;
  DepthModel depth_model = DepthModel::Plane;
};

/// The map that the user names, else that of the run; a run also tells the depth model.
ChosenMap choose_map(const RenderOptions& options) {
  if (options.run.empty()) return {load_map(options.map)};
  const RunFolder run = read_run(options.run);
  const std::string file = options.map.empty() ? run.map_file().string() : options.map;
  return {load_map(file), settings_of(run).depth_model};
}

void write_pictures(const RenderOptions& options, const Camera& camera, const ChosenMap& map,
                    std::vector<float> sensor_depth) {
  const std::vector<ViewMode> modes =
      chosen_modes(options, [&](ViewMode mode) { return missing_for(mode, options); });
  const Intrinsics& k = camera.intrinsics;
  cv::Mat colour(k.height, k.width, CV_8UC3, cv::Scalar::all(0));
  if (!options.sensor_colour.empty()) colour = read_sensor_colour(options.sensor_colour, k);
  sensor_depth.resize(static_cast<std::size_t>(k.width) * k.height, 0.0f);
  gpu::Device device({.selector = options.engine.device, .validate = options.engine.validate});
  ViewPainter painter(device);
  painter.assign(map.cloud, map.depth_model);
  painter.set_sensor(
      {.width = k.width, .height = k.height, .colour = colour.data, .depth = sensor_depth.data()}, k);
  for (ViewMode mode : modes) {
    ViewSettings view = options.view;
    view.mode = mode;
    painter.paint(camera, view);
    write_png(std::filesystem::path(options.out) / fmt::format("{}.png", info_of(mode).name),
              painter.picture());
  }
}

int render(const RenderOptions& options) {
  if (options.map.empty() && options.run.empty())
    throw InputError("give the map with --map, or a run that has left one with --run");
  if (!options.path.empty()) return render_path(options);
  if (options.camera.empty())
    throw InputError("give the camera with --camera, or a path with --path: orbit, for example");
  const Camera camera = read_camera(options.camera);
  std::vector<float> sensor_depth;
  if (!options.sensor_depth.empty()) sensor_depth = read_sensor_depth(options, camera.intrinsics);
  const ChosenMap map = choose_map(options);
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) throw InputError(options.out, "cannot be created: " + error.message());
  if (!options.modes.empty()) {
    write_pictures(options, camera, map, std::move(sensor_depth));
    return kSuccess;
  }
  SplatEngine engine(options.engine);
  engine.assign(map.cloud, map.depth_model);
  RenderImages images = sensor_depth.empty() ? engine.render(camera)
                                             : engine.render(camera, std::span<const float>(sensor_depth));
  write_images(options.out, images);
  engine.assign(coloured_by_uncertainty(map.cloud), map.depth_model);
  write_gaussian_uncertainty(options.out, engine.render(camera));
  return kSuccess;
}

/// The options of films.
void add_path_options(CLI::App& command, RenderOptions& options) {
  CLI::Option* path = command.add_option(
      "--path", options.path,
      "Renders a film along a path: orbit (around the map), follow (behind the run's camera), "
      "trajectory (the run's), truth (the dataset's), or a JSON file of keys");
  command.add_option("--run", options.run, "Folder that surefield run has written");
  command.add_option("--dataset", options.dataset, "Where the run's dataset is now");
  command
      .add_option("--show", options.shown,
                  "Shows this of the run over the pictures; may be given several times. sensor: the camera's "
                  "image in a corner")
      ->check(CLI::IsMember(shown_things()))
      ->allow_extra_args(false)
      ->take_all();
  add_size_option(command, "--size", options.size,
                  "Size of the film; the whole field of view stays in it. Default: that of the camera, else "
                  "960x540");
  command.add_option("--fps", options.rate, "Pictures a second of the film")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  add_up_option(
      command, options.up,
      "Where up is for an orbit, in the world of the map; auto (by its surfaces) or camera (as the cameras "
      "were held). Default: as the run has recorded it, else auto")
      ->needs(path);
  command.add_option("--seconds", options.seconds, "Duration of an orbit")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
}

}  // namespace

void add_render(CLI::App& program, Action& action) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand("render", "Renders a map from one camera");
  command->add_option("--map", options->map,
                      "Gaussians: PLY in the usual layout, or SPZ; default: the map of the run");
  command->add_option("--camera", options->camera, "Camera, JSON; along a path, only its intrinsics count");
  command->add_option("--out", options->out, "Folder of the images; along a path, also a film: .mp4 or .avi")
      ->required();
  add_path_options(*command, *options);
  CLI::Option* depth = command->add_option("--sensor-depth", options->sensor_depth,
                                           "16-bit PNG of the camera's size, 0 is no measurement; gives the "
                                           "uncertainty");
  CLI::Option* scale =
      command->add_option("--depth-scale", options->depth_scale,
                          "Steps per metre of the sensor depth (metres = value / scale): 5000 for TUM RGB-D");
  depth->needs(scale);
  std::vector<std::string> modes = {kAllModes};
  for (const ViewModeInfo& info : view_modes()) modes.push_back(info.name);
  command
      ->add_option("--mode", options->modes,
                   "Writes a picture of this mode instead of values; may be given several times")
      ->check(CLI::IsMember(modes))
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--sensor-colour", options->sensor_colour,
                      "Image of the camera's size, for the modes sensor and error");
  command->add_option("--far", options->view.depth_far, "Modes of depth: where the colours end, metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--device", options->engine.device,
                      "Number or part of the name of the device, see surefield devices; default: the best");
  command->footer(kRenderExamples);
  command->callback([options, &action] { action = [options] { return render(*options); }; });
}

}  // namespace surefield
