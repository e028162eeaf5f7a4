#include "engine/report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/report/html.h"
#include "engine/report/plot_axes.h"

namespace surefield {

namespace {

constexpr double kWidth = 560, kHeight = 250, kLowestMap = 170,
                 kHighestMap = 400;                                 // of the drawing, SVG units
constexpr double kLeft = 56, kRight = 12, kTop = 10, kBottom = 40;  // margins for labels
constexpr int kTicksX = 8, kTicksY = 5;
constexpr double kVisibleStep = 0.75;  // shorter moves of the pen are not seen
constexpr std::size_t kHints = 100;    // points of a series that tell their values under the mouse

std::string colour_of(int colour) {
  return colour == kReferenceColour ? "var(--reference)" : fmt::format("var(--run{})", colour % 8);
}

/// Where values land in the drawing.
struct Frame {
  AxisRange x, y;
  double height = kHeight;

  double plot_width() const { return kWidth - kLeft - kRight; }
  double plot_height() const { return height - kTop - kBottom; }
  Eigen::Vector2d place(const Eigen::Vector2d& value) const {
    return {kLeft + (value.x() - x.low) / x.size() * plot_width(),
            kTop + (y.high - value.y()) / y.size() * plot_height()};
  }
};

/// The range of one coordinate over all series; not empty.
AxisRange value_range(const Plot& plot, int coordinate) {
  AxisRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const PlotSeries& series : plot.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (!point.allFinite()) continue;
      range.low = std::min(range.low, point[coordinate]);
      range.high = std::max(range.high, point[coordinate]);
    }
  }
  if (!(range.size() > 0)) range.high = range.low + std::max(1e-6, std::abs(range.low));
  return range;
}

Frame make_frame(const Plot& plot) {
  Frame frame{value_range(plot, 0), value_range(plot, 1)};
  if (!plot.equal_scale) {
    frame.y = grown_to_ticks({std::min(0.0, frame.y.low), std::max(frame.y.high, 1e-9)}, kTicksY);
    return frame;
  }
  // The drawing is as high as the path needs, within limits; the margin keeps the line off the frame. The
  // side that is too small is widened.
  constexpr double kMargin = 1.06;
  const double wanted = frame.y.size() / frame.x.size() * frame.plot_width() + kTop + kBottom;
  frame.height = std::clamp(wanted, kLowestMap, kHighestMap);
  const double unit =
      kMargin * std::max(frame.x.size() / frame.plot_width(), frame.y.size() / frame.plot_height());
  const auto widen = [unit](AxisRange& range, double length) {
    const double middle = 0.5 * (range.low + range.high);
    range = {middle - 0.5 * unit * length, middle + 0.5 * unit * length};
  };
  widen(frame.x, frame.plot_width());
  widen(frame.y, frame.plot_height());
  return frame;
}

std::string axes(const Plot& plot, const Frame& frame) {
  const double bottom = kTop + frame.plot_height(), right = kLeft + frame.plot_width();
  std::string svg;
  const Ticks x_ticks = nice_ticks(frame.x, kTicksX), y_ticks = nice_ticks(frame.y, kTicksY);
  for (double value : x_ticks.values) {
    const double x = frame.place({value, 0}).x();
    svg += fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>", x, kTop, bottom);
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", x, bottom + 15,
                       x_ticks.label(value));
  }
  for (double value : y_ticks.values) {
    const double y = frame.place({0, value}).y();
    svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", kLeft, y, right);
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", kLeft - 6, y + 4,
                       y_ticks.label(value));
  }
  svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\"/>", kLeft, kTop, bottom, right);
  svg += fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>",
                     0.5 * (kLeft + right), frame.height - 6, escape_html(plot.x_label));
  svg += fmt::format(
      "<text class=\"label\" transform=\"translate(13 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
      0.5 * (kTop + bottom), escape_html(plot.y_label));
  return svg;
}

/// The line as an SVG path: a point is left out while the pen has hardly moved.
std::string line(const PlotSeries& series, const Frame& frame) {
  std::string path;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  bool drawing = false;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    if (!series.points[i].allFinite()) {
      drawing = false;
      continue;
    }
    const Eigen::Vector2d at = frame.place(series.points[i]);
    const bool ends = i + 1 == series.points.size() || !series.points[i + 1].allFinite();
    if (drawing && !ends && (at - last).norm() < kVisibleStep) continue;
    path += fmt::format("{}{:.1f} {:.1f}", drawing ? "L" : "M", at.x(), at.y());
    last = at;
    drawing = true;
  }
  const bool reference = series.colour == kReferenceColour;
  return fmt::format("<path class=\"{}\" stroke=\"{}\" d=\"{}\"><title>{}</title></path>",
                     reference ? "reference" : "series", colour_of(series.colour), path,
                     escape_html(series.name));
}

/// Invisible spots along the line that tell their values when the mouse rests on them.
std::string hints(const PlotSeries& series, const Frame& frame) {
  std::string svg;
  const std::size_t step = std::max<std::size_t>(1, series.points.size() / kHints);
  for (std::size_t i = 0; i < series.points.size(); i += step) {
    const Eigen::Vector2d& point = series.points[i];
    if (!point.allFinite()) continue;
    const Eigen::Vector2d at = frame.place(point);
    svg +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>{}: {:.6g}, {:.4g}</title></circle>",
                    at.x(), at.y(), escape_html(series.name), point.x(), point.y());
  }
  return "<g class=\"hints\">" + svg + "</g>";
}

/// A ring where the line starts, which maps need to be read.
std::string start_ring(const PlotSeries& series, const Frame& frame) {
  for (const Eigen::Vector2d& point : series.points) {
    if (!point.allFinite()) continue;
    const Eigen::Vector2d at = frame.place(point);
    return fmt::format(
        "<circle class=\"start\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\" stroke=\"{}\"><title>{}: "
        "start</title></circle>",
        at.x(), at.y(), colour_of(series.colour), escape_html(series.name));
  }
  return "";
}

std::string legend(const Plot& plot) {
  if (plot.series.size() < 2) return "";
  std::string html;
  for (const PlotSeries& series : plot.series) {
    html += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", colour_of(series.colour),
                        escape_html(series.name));
  }
  return "<div class=\"legend\">" + html + "</div>";
}

bool has_line(const PlotSeries& series) {
  const auto finite = [](const Eigen::Vector2d& point) { return point.allFinite(); };
  return std::count_if(series.points.begin(), series.points.end(), finite) >= 2;
}

}  // namespace

std::string plot_figure(const Plot& plot) {
  if (std::none_of(plot.series.begin(), plot.series.end(), has_line)) return "";
  const Frame frame = make_frame(plot);
  std::string svg = axes(plot, frame);
  for (const PlotSeries& series : plot.series) {
    svg += line(series, frame);
    if (plot.equal_scale) svg += start_ring(series, frame);
  }
  for (const PlotSeries& series : plot.series) svg += hints(series, frame);
  for (const PlotMark& mark : plot.marks) {
    const Eigen::Vector2d at = frame.place(mark.at);
    svg +=
        fmt::format("<circle class=\"mark\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"><title>{}</title></circle>",
                    at.x(), at.y(), escape_html(mark.text));
  }
  return fmt::format(
      "<figure><figcaption>{0}</figcaption>{1}<svg viewBox=\"0 0 {2} {3}\" role=\"img\" "
      "aria-label=\"{0}\">{4}</svg>"
      "</figure>\n",
      escape_html(plot.title), legend(plot), kWidth, frame.height, svg);
}

std::string bar_figure(const BarChart& chart) {
  double longest = 0;
  for (const StackedBar& bar : chart.bars) {
    double total = 0;
    for (double part : bar.parts) total += part;
    longest = std::max(longest, total);
  }
  std::string rows;
  for (const StackedBar& bar : chart.bars) {
    std::string parts;
    double total = 0;
    for (std::size_t i = 0; i < bar.parts.size(); ++i) {
      total += bar.parts[i];
      parts += fmt::format("<i style=\"width:{:.2f}%;background:var(--part{})\" title=\"{}: {:.1f} {}\"></i>",
                           longest > 0 ? 100 * bar.parts[i] / longest : 0, i % 4, escape_html(chart.parts[i]),
                           bar.parts[i], escape_html(chart.unit));
    }
    rows += fmt::format("<div class=\"bar\"><b>{}</b><span>{}</span><em>{:.1f} {}</em></div>",
                        escape_html(bar.name), parts, total, escape_html(chart.unit));
  }
  std::string names;
  for (std::size_t i = 0; i < chart.parts.size(); ++i) {
    names += fmt::format("<span><i style=\"background:var(--part{})\"></i>{}</span>", i % 4,
                         escape_html(chart.parts[i]));
  }
  return fmt::format(
      "<figure class=\"stages\"><figcaption>{}</figcaption><div class=\"legend\">{}</div>{}</figure>\n",
      escape_html(chart.title), names, rows);
}

}  // namespace surefield
