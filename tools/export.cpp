// surefield export: a map, or a mesh, in another file format.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "engine/io/error.h"
#include "engine/io/glb.h"
#include "engine/io/map_file.h"
#include "tools/command.h"
#include "tools/run_folder.h"

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
    "Examples:\n"
    "  surefield export --run out/desk --out desk.spz\n"
    "  surefield export --map desk.spz --out desk.compressed.ply\n"
    "  surefield export --run out/desk --format points --out desk_points.ply\n"
    "  surefield export --mesh desk_mesh.ply --out desk_mesh.glb\n";

struct ExportOptions {
  std::string map, run, mesh;  ///< one of the three; the others are empty
  std::string format;          ///< one of map_formats(); empty: as `out` ends
  std::string out;
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
  const MapFormat format = format_of(options);
  std::filesystem::path from = options.map;
  if (options.map.empty()) from = read_run(options.run).map_file();
  const MapFile map = read_map(from);
  write_map(options.out, map.cloud, format);
  fmt::print("{} Gaussians of SH degree {}: {} ({:.2f} MB) -> {} ({:.2f} MB)\n", map.cloud.size(),
             map.cloud.sh_degree, from.string(), megabytes(from), options.out, megabytes(options.out));
  if (map.dropped > 0) fmt::print("left out {} Gaussians that are not finite\n", map.dropped);
  return kSuccess;
}

int export_mesh(const ExportOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".glb")
    throw InputError(options.out, "a mesh is exported as binary glTF; name it .glb");
  const TriangleMesh mesh = read_mesh(options.mesh);
  write_glb(options.out, mesh);
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
  CLI::Option* mesh = source->add_option("--mesh", options->mesh, "PLY file of surefield mesh");
  source->require_option(1);
  std::vector<std::string> formats;
  for (const auto& [name, format] : map_formats()) formats.push_back(name);
  command->add_option("--format", options->format, "Format of the map; default: as --out ends")
      ->check(CLI::IsMember(formats))
      ->excludes(mesh);
  command->add_option("--out", options->out, "File to write")->required();
  command->footer(kExportExamples);
  command->callback([options, &action] {
    action = [options] { return options->mesh.empty() ? export_map(*options) : export_mesh(*options); };
  });
}

}  // namespace surefield
