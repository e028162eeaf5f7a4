#pragma once

#include <optional>

#include "engine/viewer/viewer_scene.h"
#include "tools/results/run_folder.h"

namespace surefield {

/// The results of a run as pictures of them need them.
struct RunScene {
  RunFolder run;
  std::optional<Dataset> dataset;  ///< nullopt where it is not there any more
  std::string missing;             ///< why it is not, one line
  /// Poses of the tracked camera; the truth, where it is known, is in the world of the estimate. The frame
  /// has intrinsics only; without the dataset they are guessed, and good for frusta alone.
  ViewerScene scene;

  /// The frame at a position in the trajectory, at the size of the run, with its estimated pose; nullopt
  /// where it cannot be read. There must be a dataset.
  std::optional<SceneFrame> load_frame(int position) const;
};

/// Reads a folder of results; `dataset`, unless empty, is where its dataset is now. Throws InputError, also
/// where the dataset cannot be read that the user names.
RunScene read_run_scene(const std::filesystem::path& folder, const std::string& dataset);

}  // namespace surefield
