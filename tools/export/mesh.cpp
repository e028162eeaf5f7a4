// surefield mesh: the options; the work is in mesh_fusion.
#include <map>
#include <memory>

#include "tools/export/mesh_fusion.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr const char* kMeshExamples =
    "Fuses depth and colour images in a truncated signed distance field and writes its surface. The images "
    "are\n"
    "those of the run's map, rendered at the estimated poses, or, for comparison, the sensor's. The mesh "
    "stands\n"
    "upright, turned about the place of the run's first camera; --axes world leaves it in the frame of the "
    "poses,\n"
    "in which trajectory.txt and map.ply are, as --trajectory does (docs/mesh.md).\n"
    "Ctrl-C writes the mesh of the frames so far; a second Ctrl-C quits at once.\n"
    "\n"
    "Examples:\n"
    "  surefield mesh --run out/desk --out desk.ply\n"
    "  surefield mesh --run out/desk --out desk.glb\n"
    "  surefield mesh --run out/desk --axes world --out desk_in_the_frame_of_the_run.ply\n"
    "  surefield mesh --run out/desk --source sensor --voxel 0.02 --truncation 0.08 --out desk.ply\n"
    "  surefield mesh --dataset Replica/room0 --source sensor --trajectory true --out room0.ply\n";

}  // namespace

void add_mesh(CLI::App& program, Action& action) {
  auto options = std::make_shared<MeshOptions>();
  CLI::App* mesh = program.add_subcommand("mesh", "Makes a triangle mesh of a run's map or of depth images");
  mesh->add_option("--run", options->run, "Folder of results of surefield run");
  mesh->add_option("--dataset", options->dataset,
                   "Folder of the dataset, where there is no run or its dataset is no longer where it was");
  mesh->add_option("--format", options->format, "Layout of the dataset")->capture_default_str();
  const std::map<std::string, MeshSource> sources = {{"rendered", MeshSource::Rendered},
                                                     {"sensor", MeshSource::Sensor}};
  mesh->add_option("--source", options->source,
                   "Whose depth and colour: the map's (rendered) or the sensor's")
      ->transform(CLI::CheckedTransformer(sources))
      ->option_text("rendered|sensor [rendered]");
  mesh->add_option("--trajectory", options->trajectory,
                   "Poses in TUM format, or \"true\" for the dataset's own; default: the run's");
  mesh->add_option("--voxel", options->fusion.voxel, "Side of a voxel, metres")->capture_default_str();
  mesh->add_option("--truncation", options->fusion.truncation,
                   "How far from the surface distances are kept, metres")
      ->capture_default_str();
  mesh->add_option("--stride", options->stride, "Takes every so many frames")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  mesh->add_option("--depth-max", options->depth_max,
                   "Leaves out depth beyond, metres; default: as configured for the run")
      ->check(CLI::PositiveNumber);
  mesh->add_option(
          "--out", options->out,
          "File of the mesh; its ending names the format, .ply, .obj, .stl (no colours) or .glb (glTF)")
      ->required();
  add_axes_option(
      *mesh, options->axes,
      "z-up for PLY and STL, y-up for OBJ and glTF, as programs expect; world with --trajectory, unless "
      "--up is given");
  add_up_option(
      *mesh, options->up,
      "Where up is in the frame of the poses; auto (by the surfaces of the run's map) or camera (as the "
      "cameras were held). Default: as the run has recorded it, else auto");
  mesh->add_option("--device", options->engine.device,
                   "Number or part of the name of the device, see surefield devices; default: the best");
  mesh->footer(kMeshExamples);
  mesh->callback([options, &action] { action = [options] { return fuse_mesh(*options); }; });
}

}  // namespace surefield
