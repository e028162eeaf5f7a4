#pragma once

#include <optional>

#include "engine/session/run_observer.h"
#include "engine/viewer/film_writer.h"
#include "engine/viewer/follower.h"
#include "engine/viewer/view_painter.h"
#include "engine/viewer/viewer_scene.h"
#include "tools/results/run_configuration.h"

namespace surefield {

/// Films a run in the third person: the map as it grows, the camera with its way and the keyframes of the
/// window, and in the corners the camera's image and what the map shows in its place. One picture a frame,
/// and a second of the finished map. Paints a copy of the map on a device of its own, so the run's results do
/// not depend on it; between frames, so that the run takes longer by the painting.
class RunFilm : public RunObserver {
 public:
  /// Throws InputError where the film that `options` name cannot be begun.
  explicit RunFilm(const RunOptions& options);

  void begin(const RunStart& start) override;
  void fed(const Frame& frame, const Slam& slam, const FrameReport& report) override;
  void finished(const Slam& slam) override;

  /// Whether filming stopped for an error, which has been printed. The run goes on without, and the film
  /// keeps what it has.
  bool failed() const { return failed_; }

 private:
  struct Stage {
    explicit Stage(const gpu::DeviceOptions& options) : device(options), painter(device) {}
    gpu::Device device;
    ViewPainter painter;
  };

  template <typename Work>
  void guard(Work work);
  void fail();
  cv::Mat paint(const Slam& slam);
  std::string caption(const Slam& slam) const;
  void close();
  void report_end();

  FilmWriter film_;
  gpu::DeviceOptions device_;
  PictureSize size_;
  bool quiet_;
  std::optional<Stage> stage_;
  DepthModel depth_model_ = DepthModel::Plane;
  spdlog::logger* log_ = nullptr;
  std::optional<int> frames_;  ///< that there are to feed; nullopt: nobody knows
  Follower follower_;
  Pose follower_pose_ = Pose::Identity();  ///< camera to world
  SceneFrame newest_;
  double seconds_ = 0;  ///< that filming took
  bool failed_ = false;
};

}  // namespace surefield
