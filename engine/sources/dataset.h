#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/types/camera.h"
#include "engine/types/frame.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// What loading one frame gave: the frame, or the reason why there is none.
struct LoadedFrame {
  std::optional<Frame> frame;
  std::string
      problem;  ///< empty where there is a frame; else one line that names the file and what is wrong with it
};

/// A recorded or synthetic RGB-D sequence. Opened once, then immutable: load() may be called from any thread.
class Dataset {
 public:
  virtual ~Dataset() = default;

  /// Name of the sequence, for reports; usually the name of its folder.
  virtual std::string name() const = 0;

  /// "tum", "replica" or another of dataset_formats(), or whatever an in-memory sequence calls itself.
  virtual std::string format() const = 0;

  /// Number of frames, the unreadable ones included.
  virtual int size() const = 0;

  /// Intrinsics at the original size, of the undistorted images.
  virtual Intrinsics intrinsics() const = 0;

  /// Metres for one step of the stored depth images.
  virtual double depth_unit() const = 0;

  /// Seconds; the original frame index where the dataset has no stamps. 0 <= i < size().
  virtual double timestamp(int i) const = 0;

  /// Seconds; when the depth image of frame `i` was taken, where the dataset says so, else timestamp(i).
  virtual double depth_timestamp(int i) const { return timestamp(i); }

  /// Reads and undistorts frame `i` at the original size, 0 <= i < size(). A missing or corrupt image is no
  /// exception: the caller skips the frame, counts it and reports the problem. Depth is not cut at any
  /// maximum.
  virtual LoadedFrame load(int i) const = 0;

  /// The true trajectory, in the stamps of timestamp(); null where the dataset has none. Poses may be
  /// non-finite.
  virtual const Trajectory* ground_truth() const = 0;

  /// From the tracked camera, whose images load() gives, to the camera that ground_truth() describes: a point
  /// in the frame of the former becomes one in the frame of the latter. They differ where depth was
  /// registered to a colour camera and the truth is that of the depth camera.
  virtual Pose tracked_to_reference() const { return Pose::Identity(); }

  /// Things the user should know that do not stop the run, one line each.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// The poses of the tracked camera as poses of the camera that the ground truth describes: what is written to
/// disk and compared with the truth.
Trajectory of_reference_camera(Trajectory tracked, const Dataset& dataset);

/// The poses of the camera that the ground truth describes as poses of the tracked camera: those at which
/// load()'s images were taken.
Trajectory of_tracked_camera(Trajectory reference, const Dataset& dataset);

/// The names of the layouts that open_dataset() reads: "tum", "replica", "sevenscenes", "scannet", "icl",
/// "plain".
std::vector<std::string> dataset_formats();

/// Opens the sequence in the folder `path` (or the ScanNet file `path`, *.sens). `format` is one of
/// dataset_formats(), or "auto" to recognise the layout. Reads lists, poses and calibration, not the images.
/// Throws InputError naming what was looked for when the folder is missing, empty, of an unknown layout or of
/// several, or when a list, a pose or a calibration cannot be read. `depth_delay`, seconds, is added to the
/// stamps of depth images before they are paired with colour images, where they have stamps of their own.
std::unique_ptr<Dataset> open_dataset(const std::filesystem::path& path, const std::string& format = "auto",
                                      double depth_delay = 0);

}  // namespace surefield
