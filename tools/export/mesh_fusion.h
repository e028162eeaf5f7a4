#pragma once

#include <optional>
#include <string>

#include "engine/mesh/tsdf_volume.h"
#include "engine/splat/engine.h"
#include "tools/export/axes_option.h"
#include "tools/shared/up_option.h"

namespace surefield {

/// Where the depth of a mesh comes from.
enum class MeshSource { Rendered, Sensor };

/// What `surefield mesh` is asked to do.
struct MeshOptions {
  std::string run;      ///< folder of results; may be empty where the source is the sensor
  std::string dataset;  ///< a folder; empty: the run's own
  std::string format = "auto";
  MeshSource source = MeshSource::Rendered;
  std::string trajectory;  ///< a TUM file, or "true" for the dataset's; empty: the run's
  TsdfSettings fusion;
  int stride = 1;        ///< takes every so many frames
  double depth_max = 0;  ///< metres; 0: as configured for the run
  std::string out;       ///< a file of one of the formats of meshes
  std::optional<MeshAxes>
      axes;     ///< of the file; nullopt: usual_axes(), or those of the poses of `trajectory`
  UpChoice up;  ///< in the world of the poses
  EngineOptions engine;
};

/// Fuses the frames and writes the mesh, also that of the frames so far when the user interrupts. Prints what
/// it did. Returns the exit code. Throws InputError, gpu::Error.
int fuse_mesh(const MeshOptions& options);

}  // namespace surefield
