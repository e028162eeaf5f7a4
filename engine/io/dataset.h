#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/frame.h"
#include "engine/io/trajectory.h"
#include "engine/splat/camera.h"

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

  /// "tum", "replica", "sevenscenes" or whatever an in-memory sequence calls itself.
  virtual std::string format() const = 0;

  /// Number of frames, the unreadable ones included.
  virtual int size() const = 0;

  /// Intrinsics at the original size, of the undistorted images.
  virtual Intrinsics intrinsics() const = 0;

  /// Metres for one step of the stored depth images.
  virtual double depth_unit() const = 0;

  /// Seconds; the original frame index where the dataset has no stamps. 0 <= i < size().
  virtual double timestamp(int i) const = 0;

  /// Reads and undistorts frame `i` at the original size, 0 <= i < size(). A missing or corrupt image is no
  /// exception: the caller skips the frame, counts it and reports the problem. Depth is not cut at any
  /// maximum.
  virtual LoadedFrame load(int i) const = 0;

  /// The true trajectory, in the stamps of timestamp(); null where the dataset has none. Poses may be
  /// non-finite.
  virtual const Trajectory* ground_truth() const = 0;

  /// Things the user should know that do not stop the run, one line each.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// Opens the sequence in `folder`. `format` is "tum", "replica", "sevenscenes", or "auto" to recognise the
/// layout. Reads lists, poses and calibration, not the images. Throws InputError naming what was looked for
/// when the folder is missing, empty, of an unknown layout, or when a list, a pose or a calibration cannot be
/// read.
std::unique_ptr<Dataset> open_dataset(const std::filesystem::path& folder,
                                      const std::string& format = "auto");

}  // namespace surefield
