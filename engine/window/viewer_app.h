#pragma once

#include <chrono>

#include "engine/viewer/pick.h"
#include "engine/viewer/timeline.h"
#include "engine/viewer/view_camera.h"
#include "engine/window/interface.h"
#include "engine/window/panel.h"
#include "engine/window/picture_labels.h"
#include "engine/window/viewer.h"

namespace surefield {

/// The viewer: takes what is new, moves the camera as the user wants, paints and shows.
class ViewerApp {
 public:
  explicit ViewerApp(ViewerInput input);

  /// Until the window is closed.
  void run();
  std::vector<std::string> validation_messages() const { return device_.validation_messages(); }

 private:
  using Clock = std::chrono::steady_clock;

  void open();
  void begin_view();
  void set_map(GaussianCloud map);
  bool take_updates();
  void end_live();
  void apply(const ViewerState& before);
  void handle_keys(const UserInput& input, ViewerRequests& requests);
  bool move_camera(const UserInput& input, double seconds);
  void place_camera();
  void play(double seconds);
  /// Whether a recorded trajectory is played back.
  bool plays() const { return !input_.live && state_.running && input_.scene.trajectory.size() > 1; }
  void choose_frame(int position);
  void jump_seconds(double seconds);
  int keyframe_shown() const;
  void go_to_keyframe(int index);
  bool has_sensor() const;
  void load_sensor();
  /// Whether there is no map yet, but will be.
  bool waits_for_map() const { return input_.live && painter_.gaussians() == 0; }
  /// That of the picture: what the user has chosen, or the camera's image while there is no map.
  ViewMode shown_mode() const;
  Under look_under(const Eigen::Vector2d& place);
  void click(const Eigen::Vector2d& place);
  void probe(const UserInput& input, Clock::time_point now);
  void forget_picks();
  void note(const std::string& text) const;
  std::vector<Line> lines(const Camera& camera) const;
  std::string distance_text() const;
  double first_time() const;  ///< seconds, of the first frame
  PanelContent panel_content() const;
  PictureLabels labels(Clock::time_point now) const;
  void lay_out(ViewerRequests& requests);
  void paint(const Eigen::Vector2i& window);
  void draw(ViewerRequests& requests);
  void fulfil(const ViewerRequests& requests);
  void save_screenshot();
  void save_map();
  /// The first name of that kind in the output folder that is free.
  std::filesystem::path free_name(const std::string& stem, const std::string& extension) const;

  ViewerInput input_;
  GlfwWindow window_;
  gpu::Device device_;
  ViewPainter painter_;
  Presenter presenter_;
  Interface interface_;
  ViewCamera camera_;
  ViewerState state_;
  std::string message_;
  bool repaint_ = true;       ///< the picture is not what it should be
  bool new_sensor_ = true;    ///< the painter has not got the images of the frame
  int shown_ = 3;             ///< times to lay the interface out before waiting for events
  int loaded_position_ = -1;  ///< whose images are loaded
  Playback playback_;
  Clock::time_point next_update_{};               ///< when to take what is new from the run
  Clock::time_point waits_since_ = Clock::now();  ///< for what the scene says
  Clock::time_point last_shown_{};                ///< when the window was drawn last

  Camera painted_;                        ///< of the picture; of no size before there is one
  std::optional<RenderImages> measured_;  ///< what the map has in the picture, once somebody asks
  std::optional<Under> picked_;           ///< that was clicked last
  std::vector<Pick> ruler_;               ///< its ends, none to two
  std::optional<Under> hint_;             ///< what is under the mouse
  Eigen::Vector2d probed_at_ = Eigen::Vector2d::Zero();  ///< where the mouse is, pixels of the window
  Clock::time_point rests_since_{};                      ///< since when it has been there
};

}  // namespace surefield
