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

/// How to read a dataset, where it does not say so itself.
struct DatasetOptions {
  std::string format = "auto";  ///< one of dataset_formats(), or "auto" to recognise the layout
  double depth_delay =
      0;  ///< seconds, added to the stamps of depth images that have their own, before they are paired
  std::string
      camera;  ///< a file as camera.yaml, or one of known_camera_names(); empty: what the dataset says
  std::optional<double> depth_unit = std::nullopt;  ///< metres for one step of the depth images
  std::string colour_topic = {};                    ///< of a log; empty: found by type, camera and name
  std::string depth_topic = {};
};

/// The names of the layouts that open_dataset() reads: "tum", "replica", "sevenscenes", "scannet", "icl",
/// "plain", "mcap", "db3", "bag".
std::vector<std::string> dataset_formats();

/// Opens the sequence in the folder `path` (or the file `path`: *.sens, *.mcap, *.db3, *.bag). Reads lists,
/// poses and calibration, not the images. The camera is that of the options, else that of a camera.yaml in
/// the folder, else that of the layout. Throws InputError naming what was looked for when the folder is
/// missing, empty, of an unknown layout or of several, or when a list or a calibration cannot be read. True
/// poses that cannot be read, or that fit no frame, are a warning of the recording: nothing but an evaluation
/// needs them.
Dataset open_dataset(const std::filesystem::path& path, const DatasetOptions& options = {});

}  // namespace surefield
