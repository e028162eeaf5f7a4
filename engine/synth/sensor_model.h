#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "engine/types/camera.h"

namespace surefield {

/// What the light, or the camera's exposure, does over a sequence beside its slow drift.
enum class ExposureCourse {
  Drift,   ///< nothing else
  Jump,    ///< falls to 0.35 of the light, and stays there
  Double,  ///< rises to twice the light, with bright things near white, and stays there
  FadeIn,  ///< comes up from darkness over the first twelve frames, as a camera's that starts
};

/// The errors of a Kinect-like camera. Every random number depends on the seed, the frame and the pixel
/// alone.
struct KinectModel {
  uint32_t seed = 1;

  // Depth.
  double nearest = 0.4, furthest = 4.5;  ///< metres
  double baseline = 0.075;               ///< metres, between projector and camera
  double disparity_step = 1.0 / 8;       ///< pixels of an image of native_width
  int native_width = 640;
  double grazing_cosine = 0.15;  ///< no echo where the surface is seen at a flatter angle
  double edge_step = 0.06;       ///< metres between neighbours that make an edge, on a surface seen head on
  double depth_readout_seconds = 0;  ///< from the first row of the depth image to the last

  // Colour.
  double read_noise = 1.2;       ///< steps of 8 bits
  double shot_noise = 0.11;      ///< times the square root of the value
  double exposure_drift = 0.12;  ///< of the brightness, up and down
  double drift_period = 9;       ///< seconds
  ExposureCourse course = ExposureCourse::Drift;
  double jump_seconds = 0;  ///< from when on ExposureCourse::Jump is dark, and Double bright
  double exposure_seconds = 1.0 / 60;
  double readout_seconds = 0.02;  ///< from the first row's exposure to the last's
  double colour_delay = 0.006;  ///< seconds from the depth image to the middle of the colour image's exposure

  /// Standard deviation of axial noise at depth z, metres.
  static double axial_sigma(double z) { return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4); }

  /// What the sensor makes of exact depth: noise, steps of disparity, and holes (0) at edges, at grazing
  /// angles and out of range.
  cv::Mat depth(const cv::Mat& exact, const Intrinsics& intrinsics, int frame) const;
  /// Adds noise to an image, CV_8UC3.
  void add_colour_noise(cv::Mat& colour, int frame) const;
  /// Factor on the light at a time: 1, but for the drift and the course.
  double brightness(double seconds) const;
};

}  // namespace surefield
