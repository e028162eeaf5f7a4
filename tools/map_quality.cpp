#include "tools/map_quality.h"

#include <algorithm>
#include <opencv2/core.hpp>

#include "engine/eval/image_metrics.h"
#include "tools/interrupt.h"

namespace surefield {

namespace {

constexpr std::size_t kMostFrames = 60;

/// PSNR of the map rendered at `camera` against the frame's colour image.
double frame_psnr(const Slam& slam, const Camera& camera, const Frame& frame) {
  RenderImages images = slam.render(camera);
  cv::Mat rendered(images.height, images.width, CV_32FC3, images.colour.data());
  // What a screen would show: displays clamp.
  rendered = cv::max(0.0f, cv::min(1.0f, rendered));
  cv::Mat truth;
  frame.colour.convertTo(truth, CV_32FC3, 1.0 / 255);
  return psnr(rendered, truth);
}

}  // namespace

void measure_map_quality(RunRecord& record, const Slam& slam, const Dataset& dataset) {
  const std::size_t fed = record.frames.size();
  const std::size_t count = std::min(fed, kMostFrames);
  double sum = 0;
  int measured = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (interrupted()) return;
    const std::size_t i = count < 2 ? 0 : k * (fed - 1) / (count - 1);
    const LoadedFrame loaded = dataset.load(record.frames[i].index);
    if (!loaded.frame || !record.trajectory[i].is_finite()) continue;
    const Camera camera{record.intrinsics, record.trajectory[i].camera_to_world.inverse()};
    sum += frame_psnr(slam, camera, resize_frame(*loaded.frame, record.selection.scale));
    ++measured;
  }
  if (measured == 0) return;
  record.psnr = sum / measured;
  record.psnr_frames = measured;
}

}  // namespace surefield
