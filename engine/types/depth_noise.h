#pragma once

namespace surefield {

/// What kinds of depth there are, each with errors of its own.
enum class DepthSensor { StructuredLight, TimeOfFlight, Stereo, Perfect };

/// How far a measured depth z is off: its standard deviation, constant + linear z + quadratic z^2. All in
/// metres.
struct DepthNoise {
  double constant = 0, linear = 0, quadratic = 0;

  double sigma(double z) const { return constant + z * (linear + z * quadratic); }
};

/// The errors of a kind of sensor:
/// - structured light: 0.0012 + 0.0019 (z - 0.4)^2, of the Kinect (Nguyen, Izadi and Lovell 2012);
/// - time of flight: 0.0015 - 0.0005 z + 0.0003 z^2, of the Kinect v2 (Fankhauser et al. 2015);
/// - stereo: 0.0005 + 0.003 z^2, of a base line of 5 cm at 640 pixels, matched to a twelfth of one;
/// - perfect, as rendered depth is: what matters then is how well a map can follow it, 0.001 z.
DepthNoise noise_of(DepthSensor sensor);

/// Depths that such a sensor cannot have measured lie beyond, metres.
double reach_of(DepthSensor sensor);

}  // namespace surefield
