#include "tools/run/run_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "engine/types/error.h"
#include "engine/viewer/film_picture.h"
#include "engine/viewer/view_path.h"
#include "tools/shared/command.h"
#include "tools/shared/say.h"

namespace surefield {

namespace {

constexpr int kRate = 25;  // pictures a second
constexpr Intrinsics kFilmLens{.width = 16, .height = 9, .fx = 13, .fy = 13, .cx = 7.5, .cy = 4};
const ViewSettings kLook;

}  // namespace

RunFilm::RunFilm(const RunOptions& options)
    : film_(options.film, kRate),
      device_{.selector = options.engine.device, .validate = options.engine.validate},
      size_(options.film_size),
      quiet_(options.quiet) {}

/// Works unless filming has failed before, and takes the time. An error ends the filming, not the run.
template <typename Work>
void RunFilm::guard(Work work) {
  if (failed_) return;
  const auto start = std::chrono::steady_clock::now();
  try {
    work();
  } catch (...) {
    fail();
  }
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The exception that is being handled has ended the filming.
void RunFilm::fail() {
  failed_ = true;
  const std::string problem = "filming has stopped: " + describe_current_exception();
  log_->error(problem);
  print_error(problem);
}

void RunFilm::begin(const RunStart& start) {
  log_ = &start.log;
  frames_ = start.source.size();
  newest_.camera.intrinsics = start.source.intrinsics();
  depth_model_ = start.settings.depth_model;
  guard([&] { stage_.emplace(device_); });
}

void RunFilm::fed(const Frame& frame, const Slam& slam, const FrameReport& report) {
  guard([&] {
    // Only keyframes change the map.
    if (report.keyframe) stage_->painter.assign(slam.map(), depth_model_);
    newest_ = {newest_.index + 1, {newest_.camera.intrinsics, report.world_to_camera}, frame.colour, {}};
    follower_pose_ = follower_.follow(report.world_to_camera.inverse());
    film_.add(paint(slam));
  });
}

void RunFilm::finished(const Slam& slam) {
  guard([&] {
    if (film_.pictures() > 0) {
      stage_->painter.assign(slam.map(), depth_model_);
      const cv::Mat last = paint(slam);
      for (int i = 0; i < kRate; ++i) film_.add(last);
    }
  });
  close();
  report_end();
}

/// Also after a failure, so that what was filmed can be seen.
void RunFilm::close() {
  try {
    film_.close();
  } catch (...) {
    fail();
  }
}

cv::Mat RunFilm::paint(const Slam& slam) {
  ViewPainter& painter = stage_->painter;
  const ViewerScene scene{.trajectory = slam.trajectory(),
                          .truth = {},
                          .keyframes = slam.keyframes(),
                          .window = slam.window(),
                          .loops = links_of(slam.loops()),
                          .frame = newest_,
                          .numbers = {},
                          .status = {}};
  const Camera follower{fit_to(kFilmLens, size_.width, size_.height), follower_pose_.inverse()};
  painter.paint(follower, kLook, lines_of(scene, {.keyframes = false}));
  cv::Mat picture = painter.picture();
  Camera tracked = newest_.camera;
  tracked.intrinsics =
      tracked.intrinsics.scaled(std::min(1.0, kInsetShare * picture.rows / tracked.intrinsics.height));
  painter.paint(tracked, kLook);
  add_inset(picture, newest_.colour, Corner::BottomLeft, "camera");
  add_inset(picture, painter.picture(), Corner::BottomRight, "map");
  add_caption(picture, caption(slam));
  return picture;
}

std::string RunFilm::caption(const Slam& slam) const {
  return fmt::format("frame {}{}{}   keyframes {}   Gaussians {}", newest_.index + 1,
                     frames_ ? fmt::format(" of {}", *frames_) : "",
                     slam.reports().back().lost() ? ", lost" : "", slam.keyframes().size(),
                     stage_->painter.gaussians());
}

void RunFilm::report_end() {
  if (stage_)
    for (const std::string& message : stage_->device.validation_messages())
      print_error("validation: " + message);
  if (film_.pictures() == 0) return;
  if (!film_.notice().empty()) say(stderr, "surefield: warning: {}\n", film_.notice());
  const std::string summary = fmt::format("{}: {} pictures, {:.1f} s of the run", film_.output().string(),
                                          film_.pictures(), seconds_);
  log_->info("film {}", summary);
  if (!quiet_) say(stdout, "film             {}\n", summary);
}

}  // namespace surefield
