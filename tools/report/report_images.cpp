// Images of a report: what the sensor saw, what the map shows, and how they differ.
#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "engine/eval/image_metrics.h"
#include "engine/report/colour_maps.h"
#include "engine/report/html.h"
#include "engine/sources/frame_stream.h"
#include "engine/types/error.h"
#include "tools/report/report_sections.h"
#include "tools/shared/interrupt.h"

namespace surefield {

namespace {

constexpr std::size_t kSpreadFrames = 3;
constexpr int kWidestImage = 480;
constexpr double kColourError = 0.25;  // end of the scale, of 1
constexpr double kDepthError = 10;     // end of the scale, cm

const ColourScale kColourScale{ColourMap::Error, 0, kColourError, "of 1"};
const ColourScale kDepthErrorScale{ColourMap::Error, 0, kDepthError, "cm"};

/// One image with what stands below it.
struct Cell {
  std::string image;
  std::string caption;
};

std::string to_html(const Cell& cell) {
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>", cell.image, escape_html(cell.caption));
}

/// A frame of the sensor at the size of a run, and its scale of depth.
struct SensorImages {
  Frame frame;
  cv::Mat valid;  ///< CV_8UC1, not 0 where the depth takes part
  ColourScale depth_scale;
};

SensorImages prepare(const Frame& frame) {
  SensorImages sensor{frame, frame.depth > 0, {}};
  double low = 0, high = 1;
  if (cv::countNonZero(sensor.valid) > 0)
    cv::minMaxLoc(frame.depth, &low, &high, nullptr, nullptr, sensor.valid);
  sensor.depth_scale = {ColourMap::Depth, low, std::max(high, low + 0.01), "m"};
  return sensor;
}

/// The map of one run, rendered; both images are of the run's size.
struct RenderedFrame {
  cv::Mat colour;  ///< CV_32FC3, 0 to 1
  cv::Mat depth;   ///< CV_32FC1, metres, 0 where the map is empty
};

RenderedFrame render(const SplatEngine& engine, const Camera& camera) {
  RenderImages images = engine.render(camera);
  const cv::Mat colour(images.height, images.width, CV_32FC3, images.colour.data());
  const cv::Mat depth(images.height, images.width, CV_32FC1, images.depth_normalised.data());
  return {cv::max(0.0f, cv::min(1.0f, colour)), depth.clone()};
}

cv::Mat to_8bit(const cv::Mat& image) {
  cv::Mat result;
  image.convertTo(result, CV_8U, 255);
  return result;
}

/// Colour and depth of the sensor, then of a render with their errors.
struct Row {
  std::vector<Cell> colour;
  std::vector<Cell> depth;
};

void add_sensor(Row& row, const SensorImages& sensor) {
  row.colour.push_back({html_image(sensor.frame.colour, "sensor image", kWidestImage), "sensor"});
  const cv::Mat depth = apply_colours(sensor.frame.depth, sensor.valid, sensor.depth_scale);
  row.depth.push_back({html_image(depth, "sensor depth", kWidestImage), "sensor depth"});
}

void add_render(Row& row, const SensorImages& sensor, const RenderedFrame& rendered,
                const std::string& name) {
  cv::Mat truth, difference, grey;
  sensor.frame.colour.convertTo(truth, CV_32FC3, 1.0 / 255);
  cv::absdiff(rendered.colour, truth, difference);
  cv::transform(difference, grey, cv::Matx13f(1.0f / 3, 1.0f / 3, 1.0f / 3));
  const cv::Mat all(grey.size(), CV_8UC1, cv::Scalar(1));
  row.colour.push_back({html_image(to_8bit(rendered.colour), "rendered image", kWidestImage),
                        fmt::format("{} ({:.1f} dB)", name, psnr(rendered.colour, truth))});
  row.colour.push_back(
      {html_image(apply_colours(grey, all, kColourScale), "colour error", kWidestImage), "colour error"});

  const cv::Mat error = 100 * cv::abs(rendered.depth - sensor.frame.depth);
  const auto mean = depth_l1(rendered.depth, sensor.frame.depth);
  row.depth.push_back({html_image(apply_colours(rendered.depth, rendered.depth > 0, sensor.depth_scale),
                                  "rendered depth", kWidestImage),
                       name + " depth"});
  row.depth.push_back(
      {html_image(apply_colours(error, sensor.valid, kDepthErrorScale), "depth error", kWidestImage),
       mean ? fmt::format("depth error (mean {:.2f} cm)", 100 * *mean) : "depth error"});
}

/// The position of a frame among those that a run has fed, if it was.
std::optional<std::size_t> position_of(const ReportRun& run, int index) {
  for (std::size_t i = 0; i < run.frames(); ++i) {
    if (run.frame(i).value("index", -1) == index) return i;
  }
  return std::nullopt;
}

/// Frames spread over those that all runs of a group know the pose of.
std::vector<int> spread_frames(const std::vector<ReportRun>& runs, const RunGroup& group) {
  std::vector<int> common;
  for (const nlohmann::json& frame : runs[group.runs.front()].folder.metrics["per_frame"]) {
    const int index = frame.value("index", -1);
    const auto has = [&](int run) {
      const auto position = position_of(runs[run], index);
      return position && !runs[run].frame(*position).value("lost", false);
    };
    if (std::all_of(group.runs.begin(), group.runs.end(), has)) common.push_back(index);
  }
  std::vector<int> indices;
  const std::size_t count = std::min(kSpreadFrames, common.size());
  for (std::size_t k = 0; k < count; ++k)
    indices.push_back(common[(2 * k + 1) * common.size() / (2 * count)]);
  return indices;
}

/// Rows of one dataset being filled run by run, so that one map at a time is on the device.
class ImageBlock {
 public:
  ImageBlock(const std::vector<ReportRun>& runs, std::vector<int> frames)
      : runs_(runs), frames_(std::move(frames)) {
    rows_.resize(frames_.size());
    scales_.resize(frames_.size());
  }

  void add(const ReportRun& run, SplatEngine& engine) {
    assign_map(engine, run.folder);
    const std::vector<QualityView> views = views_of(run.folder, *run.dataset->recording);
    for (std::size_t k = 0; k < frames_.size() && !interrupted(); ++k) {
      if (!position_of(run, frames_[k])) {
        throw InputError(
            run.folder.path,
            fmt::format("has no frame {}; --frames takes indices of frames that were fed", frames_[k]));
      }
      const LoadedFrame loaded = run.dataset->recording->load(frames_[k]);
      if (!loaded.frame) continue;
      SensorImages sensor = prepare(resize_frame(*loaded.frame, run.folder.number("/dataset/scale")));
      if (rows_[k].colour.empty()) {
        add_sensor(rows_[k], sensor);
        scales_[k] = sensor.depth_scale;
      }
      sensor.depth_scale = scales_[k];  // one for all runs, so that they can be compared
      const auto view = std::find_if(views.begin(), views.end(),
                                     [&](const QualityView& v) { return v.index == frames_[k]; });
      if (view == views.end()) continue;  // it was lost: nobody knows from where to render
      add_render(rows_[k], sensor, render(engine, view->camera), runs_.size() > 1 ? run.label : "rendered");
    }
  }

  std::string html(const std::string& title) const {
    std::string html;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (rows_[k].colour.empty()) continue;
      std::string cells;
      for (const Cell& cell : rows_[k].colour) cells += to_html(cell);
      for (const Cell& cell : rows_[k].depth) cells += to_html(cell);
      html += fmt::format(
          "<div class=\"frame\"><h3>{}frame {}</h3>\n<p class=\"scales\">{}{}{}</p>\n<div "
          "class=\"wide\"><div class=\"images\" "
          "style=\"--columns:{}\">{}</div></div></div>\n",
          escape_html(title), frames_[k], colour_legend(scales_[k], "depth"),
          colour_legend(kColourScale, "colour error"), colour_legend(kDepthErrorScale, "depth error"),
          rows_[k].colour.size(), cells);
    }
    return html;
  }

 private:
  const std::vector<ReportRun>& runs_;
  std::vector<int> frames_;
  std::vector<Row> rows_;
  std::vector<ColourScale> scales_;
};

}  // namespace

std::string image_section(const std::vector<ReportRun>& runs, const ImageOptions& options) {
  if (std::none_of(runs.begin(), runs.end(), [](const ReportRun& run) { return run.dataset.has_value(); }))
    return "";
  SplatEngine engine(options.engine);
  const std::vector<RunGroup> groups = group_by_dataset(runs);
  std::string html;
  for (const RunGroup& group : groups) {
    ImageBlock block(runs, options.frames.empty() ? spread_frames(runs, group) : options.frames);
    for (int i : group.runs) {
      if (runs[i].dataset) block.add(runs[i], engine);
    }
    html += block.html(groups.size() > 1 ? group.dataset + ": " : "");
  }
  if (html.empty()) return "";
  return "<section><h2>Rendered against sensor images</h2>\n<p class=\"note\">Grey: no valid sensor depth, "
         "or nothing in "
         "the map.</p>\n" +
         html + "</section>\n";
}

}  // namespace surefield
