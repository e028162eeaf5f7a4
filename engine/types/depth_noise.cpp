#include "engine/types/depth_noise.h"

namespace surefield {

DepthNoise noise_of(DepthSensor sensor) {
  switch (sensor) {
    case DepthSensor::StructuredLight:
      return {0.0012 + 0.0019 * 0.4 * 0.4, -2 * 0.4 * 0.0019, 0.0019};
    case DepthSensor::TimeOfFlight:
      return {0.0015, -0.0005, 0.0003};
    case DepthSensor::Stereo:
      return {0.0005, 0, 0.003};
    case DepthSensor::Perfect:
      break;
  }
  return {0, 0.001, 0};
}

double reach_of(DepthSensor sensor) {
  switch (sensor) {
    case DepthSensor::StructuredLight:
    case DepthSensor::TimeOfFlight:
      return 15;
    case DepthSensor::Stereo:
      return 100;
    case DepthSensor::Perfect:
      break;
  }
  return 1e6;
}

}  // namespace surefield
