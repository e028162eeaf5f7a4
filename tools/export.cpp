// surefield export: a map in another file format.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "engine/io/map_file.h"
#include "tools/command.h"
#include "tools/run_folder.h"

namespace surefield {

namespace {

constexpr const char* kExportExamples =
    "The ending of --out names the format, docs/formats.md describes them:\n"
    "  .ply  3D Gaussian splatting's usual layout, 32-bit floats; any splat viewer opens it\n"
    "  .spz  compact, about a sixth of that; rounded a little; for web viewers and archives\n"
    "\n"
    "Examples:\n"
    "  surefield export --run out/desk --out desk.spz\n"
    "  surefield export --map desk.spz --out desk.ply\n";

struct ExportOptions {
  std::string map, run;  ///< one of the two; the other is empty
  std::string out;
};

int export_map(const ExportOptions& options) {
  std::filesystem::path from = options.map;
  if (options.map.empty()) from = read_run(options.run).map_file();
  const MapFile map = read_map(from);
  write_map(options.out, map.cloud);
  const auto megabytes = [](const std::filesystem::path& file) {
    return 1e-6 * static_cast<double>(std::filesystem::file_size(file));
  };
  fmt::print("{} Gaussians of SH degree {}: {} ({:.2f} MB) -> {} ({:.2f} MB)\n", map.cloud.size(),
             map.cloud.sh_degree, from.string(), megabytes(from), options.out, megabytes(options.out));
  if (map.dropped > 0) fmt::print("left out {} Gaussians that are not finite\n", map.dropped);
  return kSuccess;
}

}  // namespace

void add_export(CLI::App& program, Action& action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = program.add_subcommand("export", "Writes a map in another file format");
  CLI::Option_group* source = command->add_option_group("from");
  source->add_option("--map", options->map, "Gaussians in any of the formats");
  source->add_option("--run", options->run, "Folder of results of surefield run, whose map to take");
  source->require_option(1);
  command->add_option("--out", options->out, "File to write; its ending names the format")->required();
  command->footer(kExportExamples);
  command->callback([options, &action] { action = [options] { return export_map(*options); }; });
}

}  // namespace surefield
