#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/eval/depth_delay.h"
#include "engine/slam/settings.h"
#include "engine/sources/frame_stream.h"
#include "engine/sources/open_dataset.h"
#include "tools/shared/picture_size.h"
#include "tools/shared/up_option.h"

namespace surefield {

/// What the user asks `surefield run` to do.
struct RunOptions {
  std::string dataset;    ///< a folder, or "synthetic" for the embedded sequence; empty where `live` is not
  std::string live;       ///< as open_live() takes it; empty: none
  bool realtime = false;  ///< replays the dataset at its own speed
  double speed = 1;       ///< times that
  std::optional<double> budget_ms;  ///< the key of that name; nullopt: as it is configured
  std::string poses;                ///< "-" or a file that poses are told to; empty: none
  std::string format = "auto";
  std::optional<double> depth_delay;                ///< seconds, see DatasetOptions; nullopt: estimated
  std::optional<DepthDelay> estimated_depth_delay;  ///< what depth_delay comes from, where it was estimated
  std::string assumed_camera;                       ///< as DatasetOptions::camera
  std::optional<double> assumed_depth_unit;         ///< metres for one step, as DatasetOptions::depth_unit
  std::string colour_topic;                         ///< of a log, as DatasetOptions::colour_topic
  std::string depth_topic;                          ///< the same of depth
  std::string config;                               ///< a file; empty: the built-in one of the format
  std::vector<std::string> assignments;             ///< "key=value", applied after the file
  std::string out;                                  ///< folder of the results
  bool overwrite = false;                           ///< also where that holds something
  bool strict = false;                              ///< does not run what it has doubts about
  std::string map_format = "ply";                   ///< one of run_map_formats()
  FrameSelection selection;
  EngineOptions engine;
  bool quiet = false;
  std::string film;  ///< file of a film of the run; empty: none
  PictureSize film_size{1280, 720};
  bool viewer = false;  ///< shows a window beside the run
  UpChoice up;          ///< where up is in the run's world, that of its first camera
  double ui_scale = 0;  ///< of that window, as ViewerInput::ui_scale
};

/// Opens the dataset that the options name. Throws InputError; where the options say no delay of the depth
/// images, it is none.
Dataset open_run_dataset(const RunOptions& options);

/// The options with the delay of the depth images estimated where they leave it open and depth images have
/// stamps of their own: as far as it is certain (DepthDelay::usable). Throws InputError.
RunOptions with_depth_delay(RunOptions options);

/// Where that dataset is, as it can be given to --dataset from any folder; empty of a live source.
std::string dataset_path(const RunOptions& options);

/// Reads the settings that the options and the dataset's format ask for into `settings`; returns the
/// effective configuration as YAML. Throws InputError.
std::string load_settings(SlamSettings& settings, const RunOptions& options, const std::string& format);

}  // namespace surefield
