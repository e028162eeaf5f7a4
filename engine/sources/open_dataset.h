#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/sources/recording.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// A recording, and what else is known about it.
struct Dataset {
  std::unique_ptr<Recording> recording;
  /// The true trajectory, in the stamps of Recording::timestamp, of the camera that
  /// FrameSource::tracked_to_reference leads to; nullopt where there is none. Poses may be non-finite.
  std::optional<Trajectory> ground_truth;

  /// The true trajectory, or null.
  const Trajectory* truth() const { return ground_truth ? &*ground_truth : nullptr; }
};

/// The names of the layouts that open_dataset() reads: "tum", "replica", "sevenscenes", "scannet", "icl",
/// "plain".
std::vector<std::string> dataset_formats();

/// Opens the sequence in the folder `path` (or the ScanNet file `path`, *.sens). `format` is one of
/// dataset_formats(), or "auto" to recognise the layout. Reads lists, poses and calibration, not the images.
/// Throws InputError naming what was looked for when the folder is missing, empty, of an unknown layout or of
/// several, or when a list, a pose or a calibration cannot be read. `depth_delay`, seconds, is added to the
/// stamps of depth images before they are paired with colour images, where they have stamps of their own.
Dataset open_dataset(const std::filesystem::path& path, const std::string& format = "auto",
                     double depth_delay = 0);

}  // namespace surefield
