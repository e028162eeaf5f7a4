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

/// When a frame becomes a keyframe and which keyframes are optimised together (paper section 3.4):
/// `keyframes` in configs/base.yaml.
struct KeyframeSettings {
  int interval = 15;
  double valid_below = 0.9;
  bool exposure = false;  ///< exposure.h
  int window = 4;
  int past_keyframes = 2;
  int near = 32;
  CovisibilityKind covisibility = CovisibilityKind::Overlap;
  std::string vocabulary;
  std::string netvlad;
};

/// How new Gaussians are born (paper section 3.3): `spawn` in configs/base.yaml.
struct SpawnSettings {
  int cell = 4;
  double opacity_below = 0.5;
  double front_factor = 50;
  double opacity = 0.5;
  double footprint = 1.0;
  double thickness = 0.2;
};

/// When tracking counts as lost: `lost` in configs/base.yaml.
struct LossDetectionSettings {
  double loss_jump = 4;
  double minimum_valid = 0.1;
};

/// What is done where the light changes: `light` in configs/base.yaml.
struct LightSettings {
  double correct_above = 0.15;
};

/// By how much tracking is made to drift a frame, for tests of loops: `drift` in configs/base.yaml.
struct DriftSettings {
  double rotation = 0;
  double translation = 0;
};

/// Everything that shapes a run: one field per key of configs/base.yaml, which says what each means, in which
/// unit, and which values are permitted.
struct SlamSettings {
  int seed = 1;
  DepthSensor sensor = DepthSensor::StructuredLight;
  double depth_max = 0;
  double map_device_mb = 2048;
  int first_iterations = 50;
  int mapping_iterations = 25;
  double budget_ms = 0;
  DepthModel depth_model = DepthModel::Plane;
  TrackingSettings tracking;
  MappingSettings mapping;
  DensifySettings densify;
  KeyframeSettings keyframes;
  SpawnSettings spawn;
  LossDetectionSettings lost;
  LightSettings light;
  DriftSettings drift;

  /// Binds every key to its field, with its help from configs/base.yaml; the settings must outlive the
  /// schema.
  void bind(ConfigSchema& schema);
};

}  // namespace surefield
