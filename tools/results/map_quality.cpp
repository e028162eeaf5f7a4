#include "tools/results/map_quality.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>

#include "engine/eval/image_metrics.h"
#include "engine/slam/exposure.h"
#include "engine/sources/frame_stream.h"
#include "tools/shared/interrupt.h"

namespace surefield {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kOpaque = 0.5;  // a pixel that the map covers

/// The scores of one frame.
struct FrameScores {
  double psnr = 0;
  double psnr_same_exposure = 0;
  std::optional<double> psnr_covered = {};
  double ssim = 0;
  std::optional<double> depth_l1 = {};
  std::optional<double> lpips = {};
  SpaceCounts space = {};
};

/// What a screen would show: displays clamp.
cv::Mat clamped(const cv::Mat& colour) {
  return cv::max(0.0f, cv::min(1.0f, colour));
}

/// The render with the frame's exposure instead of the map's; as it is where that cannot be told.
cv::Mat at_exposure_of(const Frame& frame, const RenderImages& images, const cv::Mat& rendered) {
  const auto gains = fit_gains(frame, images);
  if (!gains) return rendered;
  cv::Mat result;
  cv::divide(rendered, cv::Scalar((*gains)[0], (*gains)[1], (*gains)[2]), result);
  return result;
}

/// Scores of the depth, as the map shows it from where the camera was when the depth image was taken.
void score_depth(const QualityInput& input, const Camera& camera, const Frame& frame, RenderImages images,
                 FrameScores& scores) {
  if (frame.depth_after != 0) {
    const auto pose = input.track.at(frame.timestamp + frame.depth_after);
    if (pose) images = input.render({camera.intrinsics, pose->inverse()});
  }
  const cv::Mat depth(images.height, images.width, CV_32FC1, images.depth_normalised.data());
  const cv::Mat opacity(images.height, images.width, CV_32FC1, images.opacity.data());
  scores.depth_l1 = depth_l1(depth, frame.depth);
  scores.space = count_space(opacity, depth, frame.depth, input.noise);
}

FrameScores score(const QualityInput& input, const Camera& camera, const Frame& frame) {
  RenderImages images = input.render(camera);
  const cv::Mat colour(images.height, images.width, CV_32FC3, images.colour.data());
  const cv::Mat rendered = clamped(colour);
  cv::Mat truth;
  frame.colour.convertTo(truth, CV_32FC3, 1.0 / 255);
  const cv::Mat exposed = clamped(at_exposure_of(frame, images, colour));
  const cv::Mat covered = cv::Mat(images.height, images.width, CV_32FC1, images.opacity.data()) > kOpaque;
  FrameScores scores{.psnr = psnr(rendered, truth),
                     .psnr_same_exposure = psnr(exposed, truth),
                     .psnr_covered = psnr(exposed, truth, covered),
                     .ssim = ssim(rendered, truth)};
  if (input.lpips) scores.lpips = input.lpips->distance(rendered, truth);
  score_depth(input, camera, frame, std::move(images), scores);
  return scores;
}

/// Adds up the scores of frames.
class ScoreSum {
 public:
  void add(const FrameScores& scores) {
    ++sum_.frames;
    sum_.psnr += scores.psnr;
    sum_.psnr_same_exposure += scores.psnr_same_exposure;
    sum_.ssim += scores.ssim;
    add(sum_.psnr_covered, scores.psnr_covered);
    covered_frames_ += scores.psnr_covered ? 1 : 0;
    add(sum_.lpips, scores.lpips);
    add(sum_.depth_l1, scores.depth_l1);
    sum_.space += scores.space;
    depth_frames_ += scores.depth_l1 ? 1 : 0;
  }

  ImageScores mean() const {
    ImageScores mean = sum_;
    if (sum_.frames == 0) return mean;
    mean.psnr /= sum_.frames;
    mean.psnr_same_exposure /= sum_.frames;
    mean.ssim /= sum_.frames;
    if (mean.psnr_covered) *mean.psnr_covered /= covered_frames_;
    if (mean.lpips) *mean.lpips /= sum_.frames;
    if (mean.depth_l1) *mean.depth_l1 /= depth_frames_;
    return mean;
  }

 private:
  static void add(std::optional<double>& sum, const std::optional<double>& value) {
    if (value) sum = sum.value_or(0) + *value;
  }

  ImageScores sum_;
  int depth_frames_ = 0, covered_frames_ = 0;
};

nlohmann::ordered_json scores_json(const ImageScores& scores) {
  const auto number = [&](double value) { return scores.frames > 0 ? Json(value) : Json(nullptr); };
  Json json = {{"frames", scores.frames},
               {"psnr_db", number(scores.psnr)},
               {"psnr_same_exposure_db", number(scores.psnr_same_exposure)},
               {"psnr_covered_db", scores.psnr_covered ? Json(*scores.psnr_covered) : Json(nullptr)},
               {"ssim", number(scores.ssim)},
               {"depth_l1_m", scores.depth_l1 ? Json(*scores.depth_l1) : Json(nullptr)},
               {"floaters", scores.depth_l1 ? Json(scores.space.floaters()) : Json(nullptr)},
               {"coverage", scores.depth_l1 ? Json(scores.space.coverage()) : Json(nullptr)}};
  if (scores.lpips) json["lpips"] = *scores.lpips;
  return json;
}

std::string scores_line(const char* title, const ImageScores& scores) {
  std::string text = fmt::format("{:<16} PSNR {:.2f} dB (at each frame's exposure {:.2f}", title, scores.psnr,
                                 scores.psnr_same_exposure);
  if (scores.psnr_covered) text += fmt::format(", where covered {:.2f}", *scores.psnr_covered);
  text += fmt::format("), SSIM {:.4f}", scores.ssim);
  if (scores.depth_l1)
    text += fmt::format(", depth L1 {:.2f} cm, floaters {:.2f} %, coverage {:.1f} %", 100 * *scores.depth_l1,
                        100 * scores.space.floaters(), 100 * scores.space.coverage());
  if (scores.lpips) text += fmt::format(", LPIPS {:.4f}", *scores.lpips);
  return text + fmt::format("   ({} frames)\n", scores.frames);
}

}  // namespace

std::function<std::optional<Frame>(int)> frames_of(const Recording& recording, double scale) {
  return [&recording, scale](int index) -> std::optional<Frame> {
    const LoadedFrame loaded = recording.load(index);
    return loaded.frame ? std::optional(resize_frame(*loaded.frame, scale)) : std::nullopt;
  };
}

std::optional<MapQuality> measure_map_quality(const QualityInput& input) {
  ScoreSum all, held_out;
  for (std::size_t i = 0; i < input.views.size(); ++i) {
    if (interrupted()) return std::nullopt;
    const QualityView& view = input.views[i];
    const std::optional<Frame> frame = input.frame(view.index);
    if (frame && view.camera.world_to_camera.matrix().allFinite()) {
      const FrameScores scores = score(input, view.camera, *frame);
      all.add(scores);
      if (!view.keyframe) held_out.add(scores);
    }
    if (input.progress) input.progress(i + 1);
  }
  const MapQuality quality{all.mean(), held_out.mean()};
  return quality.all.frames > 0 ? std::optional(quality) : std::nullopt;
}

nlohmann::ordered_json quality_json(const std::optional<MapQuality>& quality) {
  const MapQuality scores = quality.value_or(MapQuality{});
  nlohmann::ordered_json json = scores_json(scores.all);
  json["held_out"] = scores_json(scores.held_out);
  return json;
}

std::string quality_table(const MapQuality& quality) {
  std::string text = scores_line("images", quality.all);
  if (quality.held_out.frames > 0) text += scores_line("held-out frames", quality.held_out);
  return text;
}

}  // namespace surefield
