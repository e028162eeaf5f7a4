#pragma once

#include <chrono>

#include "engine/viewer/view_camera.h"
#include "engine/window/interface.h"
#include "engine/window/panel.h"
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

  void begin_view();
  void set_map(GaussianCloud map);
  bool take_updates();
  void apply(const ViewerState& before);
  void handle_keys(const UserInput& input, ViewerRequests& requests);
  bool move_camera(const UserInput& input, double seconds);
  void place_camera();
  void play(double seconds);
  void choose_frame(int position);
  void jump_keyframes(int count);
  bool has_sensor() const;
  void load_sensor();
  PanelContent panel_content() const;
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
  bool finished_ = false;            ///< the run has ended
  bool repaint_ = true;              ///< the picture is not what it should be
  bool new_sensor_ = true;           ///< the painter has not got the images of the frame
  int shown_ = 3;                    ///< times to lay the interface out before waiting for events
  int loaded_position_ = -1;         ///< whose images are loaded
  double played_ = 0;                ///< frames that playback is ahead of the position
  Clock::time_point next_update_{};  ///< when to take what is new from the run
};

}  // namespace surefield
