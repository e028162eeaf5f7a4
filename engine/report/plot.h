#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace surefield {

/// The colour of a series that is not a run: the truth.
constexpr int kReferenceColour = -1;

/// A line of a plot.
struct PlotSeries {
  std::string name;
  int colour = 0;                       ///< number of the run, or kReferenceColour
  std::vector<Eigen::Vector2d> points;  ///< a point that is not finite interrupts the line
};

/// A point of a plot that stands out, such as a frame that was lost.
struct PlotMark {
  Eigen::Vector2d at;
  std::string text;  ///< shown when the mouse rests on it
};

/// A diagram with two axes.
struct Plot {
  std::string title;
  std::string x_label;  ///< with its unit
  std::string y_label;
  std::vector<PlotSeries> series;  ///< the first is drawn first
  std::vector<PlotMark> marks;
  bool equal_scale = false;  ///< one unit is as long on both axes, as on a map; else y starts at zero
};

/// The plot as an HTML figure: title, legend where there are several series, and inline SVG whose colours are
/// the CSS variables --run0, --run1, ..., --reference, --text, --grid and --bad. Lines are thinned to what
/// can be seen, so that a thousand frames stay small. Empty where no series has two finite points.
std::string plot_figure(const Plot& plot);

/// One bar of a bar chart, made of parts.
struct StackedBar {
  std::string name;
  std::vector<double> parts;
};

/// Horizontal bars that show how totals divide.
struct BarChart {
  std::string title;
  std::string unit;
  std::vector<std::string> parts;  ///< their names; coloured as --part0, --part1, ...
  std::vector<StackedBar> bars;
};

/// The chart as an HTML figure.
std::string bar_figure(const BarChart& chart);

}  // namespace surefield
