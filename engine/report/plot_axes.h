#pragma once

#include <string>
#include <vector>

namespace surefield {

/// An interval of values on an axis.
struct AxisRange {
  double low = 0;
  double high = 1;

  double size() const { return high - low; }
};

/// Values at which an axis is labelled: multiples of 1, 2 or 5 times a power of ten.
struct Ticks {
  double step = 1;
  std::vector<double> values;

  /// A tick's label, with the decimals that the step needs.
  std::string label(double value) const;
};

/// About `count` ticks within the range, which is not empty.
Ticks nice_ticks(const AxisRange& range, int count);

/// The range grown to whole steps of its ticks, so that a line does not touch the frame.
AxisRange grown_to_ticks(const AxisRange& range, int count);

}  // namespace surefield
