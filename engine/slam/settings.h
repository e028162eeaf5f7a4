#pragma once

#include <cstdint>
#include <string>

#include "engine/splat/requests.h"
#include "engine/types/depth_model.h"

namespace surefield {

class ConfigSchema;

/// How the keyframes that see the same are found: by reprojecting their depth, or by describing their images
/// with VLAD over RootSIFT or with a network.
enum class CovisibilityKind { Overlap, Vlad, NetVlad };

/// When a frame becomes a keyframe and which keyframes are optimised together (paper section 3.4).
struct KeyframeSettings {
  int interval = 15;         ///< every so many frames
  double valid_below = 0.9;  ///< also when the map explains less of the sensor's depth than this times what
                             ///< it explained just after the last keyframe
  bool exposure = false;     ///< bring their colours to the exposure of the map (exposure.h)
  int window = 4;            ///< k: current, most recent, and the k - 2 that see most of the same
  int past_keyframes = 2;    ///< random older keyframes among the steps, against forgetting
  int near = 32;             ///< the window and the older ones are among so many nearest to the current
  CovisibilityKind covisibility = CovisibilityKind::Overlap;
  std::string vocabulary;  ///< file of the visual words of Vlad; empty: the built-in one
  std::string netvlad;     ///< ONNX file of NetVlad
};

/// How new Gaussians are born (paper section 3.3).
struct SpawnSettings {
  double opacity_below = 0.5;  ///< psi: a pixel whose rendered O is below spawns one
  double front_factor =
      50;  ///< also where the map lies behind the sensor depth by so many median errors; 0: never
  double opacity = 0.5;    ///< at birth
  double footprint = 1.0;  ///< radius at birth, in pixels at its depth
  double thickness = 0.2;  ///< along the surface's normal, in radii; 1: a sphere
};

/// When tracking counts as lost.
struct LossDetectionSettings {
  double loss_jump = 4;        ///< loss above so many times the mean of the last frames
  double minimum_valid = 0.1;  ///< fraction of the pixels with sensor depth that took part
};

/// Everything that shapes a run; one field per key of configs/base.yaml.
struct SlamSettings {
  int seed = 1;                 ///< drives every random choice
  double depth_max = 5;         ///< metres; depth beyond is invalid
  double map_device_mb = 2048;  ///< most device memory of the Gaussians, 10^6 bytes
  int first_iterations = 100;   ///< mapping steps on the first frame
  int mapping_iterations = 40;  ///< mapping steps per keyframe
  DepthModel depth_model = DepthModel::Plane;
  TrackingSettings tracking;
  MappingSettings mapping;
  DensifySettings densify;
  KeyframeSettings keyframes;
  SpawnSettings spawn;
  LossDetectionSettings lost;

  /// Binds every key (configs/base.yaml) to its field; the settings must outlive the schema.
  void bind(ConfigSchema& schema);
};

}  // namespace surefield
