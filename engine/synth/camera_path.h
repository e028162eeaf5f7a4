#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/synth/scene.h"
#include "engine/types/camera.h"

namespace surefield {

/// How a camera moves.
struct PathStyle {
  const char* name;
  double speed;        ///< metres a second, on average
  double speed_swing;  ///< how far the speed goes up and down around that
  double turn_limit;   ///< radians a second
  double jitter;       ///< how far laps leave the scene's circuit, metres
  double shake;        ///< 1: as a hand shakes
  bool look_ahead;     ///< level and along the way, as a robot does; else at what the circuit names
  double height;       ///< of the camera above the floor where it looks ahead, metres
  double circle =
      0;  ///< metres; not 0: it does not follow the circuit, but turns round on a circle of this radius
};

/// The path styles by name: robot, handheld, fast, loop, turn.
std::vector<std::string> path_names();

/// The style of that name. Throws InputError for an unknown one.
const PathStyle& path_style(const std::string& name);

/// A smooth walk through a scene along its circuit: positions on a cubic B-spline run through at a smoothly
/// varying speed, viewing directions filtered until they turn within the limit. Or a turn on the spot,
/// looking outwards, where the circuit has most room. Nothing is nearer than 0.25 m to it. The same on every
/// run.
class CameraPath {
 public:
  /// A walk of `seconds`. Throws InputError where the scene has no room for it.
  CameraPath(const Scene& scene, const PathStyle& style, uint32_t seed, double seconds);

  /// World to camera, -0.1 <= `seconds` <= the length of the walk + 0.1.
  Pose world_to_camera(double seconds) const;

  /// When the camera is back where it began for the first time, seconds; of styles without jitter only.
  double lap_seconds() const { return lap_seconds_; }

 private:
  struct Sample {
    Eigen::Vector3d position;
    double yaw, pitch;
  };
  void walk(const Scene& scene, const PathStyle& style, double jitter, std::size_t count);
  void turn_round(const Scene& scene, const PathStyle& style, std::size_t count);
  bool is_clear(const Scene& scene) const;
  void limit_turns(const PathStyle& style);

  std::vector<Sample> samples_;  ///< evenly spaced in time, from kMargin before the start
  double lap_seconds_ = 0;
  double shake_ = 0;
  uint32_t seed_ = 0;
};

}  // namespace surefield
