// surefield export: a map, or a mesh, in another file format, or a web page that shows a map.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "engine/formats/map_file.h"
#include "engine/formats/mesh_file.h"
#include "engine/io/files.h"
#include "engine/types/error.h"
#include "tools/export/axes_option.h"
#include "tools/export/web_page.h"
#include "tools/report/report_data.h"
#include "tools/shared/command.h"
#include "tools/shared/load_map.h"
#include "tools/shared/up_option.h"

namespace surefield {

namespace {

constexpr const char* kExportExamples =
    "The ending of --out names the format, or --format where it may be one of several (docs/formats.md):\n"
    "  ply     .ply             3D Gaussian splatting's usual layout, 32-bit floats; any splat viewer opens "
    "it\n"
    "  cply    .compressed.ply  a quarter of that, rounded; for SuperSplat and other web viewers\n"
    "  spz     .spz             a sixth, rounded; for web viewers and archives\n"
    "  glb     .glb             glTF with KHR_gaussian_splatting; not read back\n"
    "  points  .ply             centres with colours, for CloudCompare, MeshLab and others; not read back\n"
    "\n"
    "--web writes a folder with one page, index.html, that shows the map, and of a run the trajectory, the "
    "truth and\n"
    "the keyframes, in any browser, opened from disk or from a server; it needs no network.\n"
    "\n"
    "Examples:\n"
    "  surefield export --run out/desk --out desk.spz\n"
    "  surefield export --map desk.spz --out desk.compressed.ply\n"
    "  surefield export --run out/desk --format points --out desk_points.ply\n"
    "  surefield export --mesh desk_mesh.ply --out desk_mesh.glb   # or .obj, .stl\n"
    "  surefield export --run out/desk --web desk_web\n"
    "  surefield export --map map.ply --up 0,-0.9,-0.4 --web map_web\n";

constexpr Intrinsics kUsualCamera = {640, 480, 525, 525, 319.5, 239.5};  // of most RGB-D sensors

struct ExportOptions {
  std::string map, run, mesh;  ///< one of the three; the others are empty
  std::string format;          ///< one of map_formats(); empty: as `out` ends
  std::string out;
  std::string web;               ///< folder of the page; empty: `out` is written
  std::string dataset;           ///< of the run, where it is no longer where it was
  UpChoice up;                   ///< of the page or the mesh
  std::optional<MeshAxes> axes;  ///< of a mesh; nullopt: usual_axes() where it is known where up is
};

double megabytes(const std::filesystem::path& file) {
  return 1e-6 * static_cast<double>(std::filesystem::file_size(file));
}

/// The format that the options ask for. Throws InputError where the name of the file says another.
MapFormat format_of(const ExportOptions& options) {
  if (options.format.empty()) return map_format_of(options.out);
  const MapFormat format = map_formats().at(options.format);
  const std::string ending = format == MapFormat::Spz ? ".spz" : format == MapFormat::Glb ? ".glb" : ".ply";
  const MapFormat named = map_format_of(options.out);
  const bool fits = std::filesystem::path(options.out).extension() == ending &&
                    (named != MapFormat::CompressedPly || format == named);
  if (!fits)
    throw InputError(options.out, fmt::format("is named like another format than --format {}; name it {}",
                                              options.format, ending));
  return format;
}

int export_map(const ExportOptions& options) {
  if (options.up.way != UpChoice::Way::Recorded)
    throw InputError("--up is of a page (--web) or of a mesh; maps are written in the world of their run");
  const MapFormat format = format_of(options);
  std::filesystem::path from = options.map;
  if (options.map.empty()) from = read_run(options.run).map_file();
  const GaussianCloud map = load_map(from);
  write_map(options.out, map, format);
  fmt::print("{} Gaussians of SH degree {}: {} ({:.2f} MB) -> {} ({:.2f} MB)\n", map.size(), map.sh_degree,
             from.string(), megabytes(from), options.out, megabytes(options.out));
  return kSuccess;
}

/// What the page shows of a run beside its map. A dataset that is not there any more is noted.
void show_run(const ExportOptions& options, WebPageContent& content) {
  const std::vector<ReportRun> runs = load_report_runs({options.run}, options.dataset);
  const ReportRun& run = runs.front();
  content.estimate = run.folder.trajectory;
  content.keyframes = run.folder.keyframes;
  if (!run.dataset) {
    fmt::print(stderr, "surefield: note: the page shows no truth and the usual camera: {}\n",
               run.dataset_problem);
    return;
  }
  content.camera = run.dataset->recording->intrinsics().scaled(run.folder.number("/dataset/scale"));
  for (const PosePair& pair : run.pairs)
    content.truth.push_back({pair.timestamp, run.accuracy->alignment.inverse() * pair.truth});
  for (Trajectory* poses : {&content.estimate, &content.keyframes, &content.truth})
    *poses = of_tracked_camera(std::move(*poses), *run.dataset->recording);
}

int export_web(const ExportOptions& options) {
  WebPageContent content{.camera = kUsualCamera};
  std::filesystem::path from = options.map;
  std::optional<UpDirection> recorded;
  if (options.map.empty()) {
    const RunFolder run = read_run(options.run);
    from = run.map_file();
    recorded = run.up();
    content.title = run.name;
    show_run(options, content);
  } else {
    content.title = from.stem().string();
  }
  content.map = load_map(from);
  content.up = options.up.of(content.map, content.estimate, recorded).up;
  std::error_code error;
  std::filesystem::create_directories(options.web, error);
  if (error) throw InputError(options.web, "cannot be created: " + error.message());
  const std::filesystem::path file = std::filesystem::path(options.web) / "index.html";
  const std::string page = web_page(content);
  write_file(file, [&](std::ostream& stream) { stream << page; });
  fmt::print("{} Gaussians, {} poses, {} keyframes: {} ({:.2f} MB)\n", content.map.size(),
             content.estimate.size(), content.keyframes.size(), file.string(), megabytes(file));
  return kSuccess;
}

int export_mesh(const ExportOptions& options) {
  require_mesh_ending(options.out);
  TriangleMesh mesh = read_mesh(options.mesh);
  if (options.up.way == UpChoice::Way::Given) {
    mesh.up = options.up.given;
  } else if (options.up.way != UpChoice::Way::Recorded) {
    throw InputError(
        "--up of a mesh is a direction, as 0,-1,0: there are neither a map nor cameras to tell it");
  }
  const MeshAxes axes = options.axes.value_or(mesh.up ? usual_axes(options.out) : MeshAxes::World);
  if (axes != MeshAxes::World && !mesh.up)
    throw InputError(options.mesh, "does not say where up is; give --up, as 0,-1,0");
  write_mesh_file(options.out, mesh, axes);
  fmt::print("{} vertices, {} triangles: {} ({:.2f} MB) -> {} ({:.2f} MB)\n", mesh.vertices.size(),
             mesh.triangles.size(), options.mesh, megabytes(options.mesh), options.out,
             megabytes(options.out));
  return kSuccess;
}

}  // namespace

void add_export(CLI::App& program, Action& action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = program.add_subcommand("export", "Writes a map or a mesh in another file format");
  CLI::Option_group* source = command->add_option_group("from");
  source->add_option("--map", options->map, "Gaussians in any of the formats that are read");
  source->add_option("--run", options->run, "Folder of results of surefield run, whose map to take");
  CLI::Option* run = source->get_option("--run");
  CLI::Option* mesh = source->add_option("--mesh", options->mesh, "PLY file of surefield mesh");
  source->require_option(1);
  std::vector<std::string> formats;
  for (const auto& [name, format] : map_formats()) formats.push_back(name);
  CLI::Option_group* target = command->add_option_group("to");
  CLI::Option* out = target->add_option("--out", options->out, "File to write");
  CLI::Option* web =
      target->add_option("--web", options->web, "Folder to write a web page to")->excludes(mesh);
  target->require_option(1);
  command->add_option("--format", options->format, "Format of the map; default: as --out ends")
      ->check(CLI::IsMember(formats))
      ->needs(out)
      ->excludes(mesh);
  command
      ->add_option("--dataset", options->dataset,
                   "Folder of the run's dataset, where it is no longer where it was; has the truth")
      ->needs(run)
      ->needs(web);
  add_up_option(
      *command, options->up,
      "Where up is on the page, in the world of the map; auto (by its surfaces) or camera (as the cameras "
      "were held). Default: as the run has recorded it, else auto. Of a mesh, in the world of its run");
  add_axes_option(
      *command, options->axes,
      "upright where the mesh or --up says where up is: z-up for PLY and STL, y-up for OBJ and glTF")
      ->needs(mesh);
  command->footer(kExportExamples);
  command->callback([options, &action] {
    action = [options] {
      if (!options->mesh.empty()) return export_mesh(*options);
      return options->web.empty() ? export_map(*options) : export_web(*options);
    };
  });
}

}  // namespace surefield
